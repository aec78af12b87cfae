// SPDX-License-Identifier: MIT
// PLY to particles: which properties of element `vertex` mean what.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "builder.hpp"
#include "ply_body.hpp"
#include "ply_header.hpp"

namespace sluice::particles {

namespace {

using ply::Element;
using ply::Property;
using ply::Type;

enum class Channel : std::uint8_t { x, y, z, vx, vy, vz, red, green, blue, radius, none };
constexpr std::size_t kChannels = static_cast<std::size_t>(Channel::none);

struct Meaning {
    std::string_view name;
    Channel channel;
};
constexpr std::array<Meaning, 14> kMeanings{{{"x", Channel::x},
                                             {"y", Channel::y},
                                             {"z", Channel::z},
                                             {"vx", Channel::vx},
                                             {"vy", Channel::vy},
                                             {"vz", Channel::vz},
                                             {"velocity_x", Channel::vx},
                                             {"velocity_y", Channel::vy},
                                             {"velocity_z", Channel::vz},
                                             {"red", Channel::red},
                                             {"green", Channel::green},
                                             {"blue", Channel::blue},
                                             {"radius", Channel::radius},
                                             {"pscale", Channel::radius}}};

struct Plan {
    std::vector<Channel> channels;  ///< one per property
    std::array<const Property*, kChannels> source{};
    [[nodiscard]] bool has(Channel channel) const { return source[static_cast<std::size_t>(channel)] != nullptr; }
};

std::string listNames(const Element& element) {
    std::string names;
    for (const Property& property : element.properties) {
        names += (names.empty() ? "" : " ") + property.name;
    }
    return printable(names);
}

/// Three channels of which either all or none are there.
Status checkTriple(const Plan& plan, Channel first, const Element& element, const std::string& name,
                   std::string_view what) {
    const auto at = static_cast<std::size_t>(first);
    const auto there = std::count_if(plan.source.begin() + static_cast<std::ptrdiff_t>(at),
                                     plan.source.begin() + static_cast<std::ptrdiff_t>(at) + 3,
                                     [](const Property* property) { return property != nullptr; });
    const bool required = first == Channel::x;
    if (there != 3 && (required || there != 0)) {
        return failure(name, atLine(element.line), fmt::format("properties {} of element 'vertex'", what),
                       listNames(element));
    }
    return {};
}

Result<Plan> planVertex(const Element& element, const std::string& name) {
    Plan plan;
    for (const Property& property : element.properties) {
        const auto* meaning = std::ranges::find(kMeanings, property.name, &Meaning::name);
        const Channel channel = meaning == kMeanings.end() ? Channel::none : meaning->channel;
        plan.channels.push_back(channel);
        if (channel == Channel::none) {
            continue;
        }
        if (property.list_count) {
            return failure(name, atLine(element.line),
                           fmt::format("a number per vertex for {}", printable(property.name)), "a list");
        }
        const Property*& source = plan.source[static_cast<std::size_t>(channel)];
        if (source != nullptr) {
            return failure(name, atLine(element.line), fmt::format("one of {} and {}", source->name, property.name),
                           "both");
        }
        const bool colour = channel == Channel::red || channel == Channel::green || channel == Channel::blue;
        const bool known = property.type == Type::u8 || property.type == Type::u16 || property.type == Type::f32 ||
                           property.type == Type::f64;
        if (colour && !known) {
            return failure(name, atLine(element.line), "colours as uchar, ushort, float or double",
                           fmt::format("{} {}", nameOf(property.type), property.name));
        }
        source = &property;
    }
    for (const auto& [first, what] :
         {std::pair{Channel::x, "x, y and z"}, std::pair{Channel::vx, "vx, vy and vz together"},
          std::pair{Channel::red, "red, green and blue together"}}) {
        if (const Status ok = checkTriple(plan, first, element, name, what); !ok) {
            return ok.error();
        }
    }
    return plan;
}

/// Integer colours are what a viewer shows, so they carry the sRGB curve (IEC 61966-2-1); floats are linear already.
float linearColour(double value, Type type) {
    if (type == Type::f32 || type == Type::f64) {
        return static_cast<float>(value);
    }
    const double encoded = value / (type == Type::u8 ? 255.0 : 65535.0);
    return static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
}

Status readVertex(const Element& element, const Plan& plan, ply::Body& body, Builder& builder) {
    std::array<float, kChannels> value{};
    std::array<Place, kChannels> place{};
    for (std::size_t i = 0; i < plan.channels.size(); ++i) {
        const Property& property = element.properties[i];
        const Channel channel = plan.channels[i];
        if (channel == Channel::none) {
            if (Status ok = body.skip(property); !ok) {
                return ok;
            }
            continue;
        }
        const Result<double> number = body.take(property);
        if (!number) {
            return number.error();
        }
        const auto at = static_cast<std::size_t>(channel);
        const bool colour = channel >= Channel::red && channel <= Channel::blue;
        value[at] = colour ? linearColour(number.value(), property.type) : static_cast<float>(number.value());
        place[at] = body.place();
    }
    if (Status ok = builder.addPosition({value[0], value[1], value[2]}, place[0]); !ok) {
        return ok;
    }
    if (Status ok = plan.has(Channel::vx) ? builder.addVelocity({value[3], value[4], value[5]}, place[3]) : Status();
        !ok) {
        return ok;
    }
    if (Status ok = plan.has(Channel::red) ? builder.addColour({value[6], value[7], value[8]}, place[6]) : Status();
        !ok) {
        return ok;
    }
    return plan.has(Channel::radius) ? builder.addRadius(value[9], place[9]) : Status();
}

Status readElement(const Element& element, const Plan& plan, ply::Body& body, Builder& builder) {
    if (Status ok = body.beginElement(element); !ok) {
        return ok;
    }
    const bool vertex = element.name == "vertex";
    if (vertex) {
        builder.reserve(body.mostInstances(), plan.has(Channel::vx), plan.has(Channel::red));
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
        if (Status ok = body.beginInstance(); !ok) {
            return ok;
        }
        if (vertex) {
            if (Status ok = readVertex(element, plan, body, builder); !ok) {
                return ok;
            }
        } else {
            for (const Property& property : element.properties) {
                if (Status ok = body.skip(property); !ok) {
                    return ok;
                }
            }
        }
        if (Status ok = body.endInstance(); !ok) {
            return ok;
        }
    }
    return {};
}

}  // namespace

Result<ParticleSet> parsePly(std::span<const std::byte> bytes, const std::string& name) {
    const Result<ply::Header> header = ply::parseHeader(bytes, name);
    if (!header) {
        return header.error();
    }
    const auto& elements = header.value().elements;
    const auto vertex = std::ranges::find(elements, "vertex", &Element::name);
    if (vertex == elements.end()) {
        return failure(name, atLine(header.value().body_line - 1), "an element 'vertex' in the header", "none");
    }
    const Result<Plan> plan = planVertex(*vertex, name);
    if (!plan) {
        return plan.error();
    }
    Builder builder(name);
    if (header.value().radius) {
        if (const Status ok = builder.setRadius(*header.value().radius, atLine(header.value().radius_line)); !ok) {
            return ok.error();
        }
    }
    ply::Body body(bytes, header.value(), name);
    for (const Element& element : elements) {
        if (const Status ok = readElement(element, plan.value(), body, builder); !ok) {
            return ok.error();
        }
    }
    if (const Status ok = body.end(); !ok) {
        return ok.error();
    }
    return builder.finish();
}

}  // namespace sluice::particles
