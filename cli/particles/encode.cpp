// SPDX-License-Identifier: MIT
#include "encode.hpp"

#include <bit>
#include <string_view>

#include <fmt/format.h>

#include "builder.hpp"
#include "bytes.hpp"
#include "gzip.hpp"

namespace sluice::particles {

namespace {

Error unfit(const std::string& name, std::string detail, std::string remedy) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, name, std::move(detail), std::move(remedy)};
}

Status checkValues(const std::vector<float>& values, std::string_view what, const std::string& name) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!usableCoordinate(values[i])) {
            return unfit(name, fmt::format("cannot write {} of particle {}: {}", what, i / 3, values[i]),
                         "a file holds finite values only; repair the set");
        }
    }
    return {};
}

Status checkSet(const ParticleSet& set, Format format, const std::string& name) {
    const std::size_t size = set.position.size();
    if (size % 3 != 0 || set.count() > kMaxParticles || (!set.velocity.empty() && set.velocity.size() != size) ||
        (!set.colour.empty() && set.colour.size() != size)) {
        return unfit(name,
                     fmt::format("cannot write {} position, {} velocity and {} colour values", size,
                                 set.velocity.size(), set.colour.size()),
                     "each array holds three values per particle or none");
    }
    if (set.radius != 0.0F || format == Format::pos) {
        if (!usableRadius(set.radius)) {
            return unfit(name, fmt::format("cannot write the radius {} m", set.radius),
                         fmt::format("give the set a radius from {} to {} m", kMinRadius, kMaxRadius));
        }
    }
    for (const auto& [values, what] :
         {std::pair{&set.position, "the position"}, std::pair{&set.velocity, "the velocity"},
          std::pair{&set.colour, "the colour"}}) {
        if (Status ok = checkValues(*values, what, name); !ok) {
            return ok;
        }
    }
    return {};
}

template <std::endian order>
void appendTriple(std::vector<std::byte>& out, const std::vector<float>& values, std::size_t particle) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        appendNumber<float, order>(out, values[3 * particle + axis]);
    }
}

std::vector<std::byte> encodePos(const ParticleSet& set) {
    std::vector<std::byte> out;
    out.reserve(8 + 4 * set.position.size());
    appendLittle(out, static_cast<std::uint32_t>(set.count()));
    appendLittle(out, set.radius);
    for (const float value : set.position) {
        appendLittle(out, value);
    }
    return out;
}

std::vector<std::byte> encodePly(const ParticleSet& set) {
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment particles written by sluice; metres, +y up\n";
    if (set.radius > 0.0F) {
        header += fmt::format("obj_info radius {}\n", set.radius);
    }
    header += fmt::format("element vertex {}\n", set.count());
    header += "property float x\nproperty float y\nproperty float z\n";
    if (!set.velocity.empty()) {
        header += "property float vx\nproperty float vy\nproperty float vz\n";
    }
    if (!set.colour.empty()) {
        header += "property float red\nproperty float green\nproperty float blue\n";
    }
    header += "end_header\n";
    std::vector<std::byte> out;
    out.reserve(header.size() + 4 * (set.position.size() + set.velocity.size() + set.colour.size()));
    appendText(out, header);
    for (std::size_t i = 0; i < set.count(); ++i) {
        for (const auto* values : {&set.position, &set.velocity, &set.colour}) {
            if (!values->empty()) {
                appendTriple<std::endian::little>(out, *values, i);
            }
        }
    }
    return out;
}

void appendAttribute(std::vector<std::byte>& out, std::string_view name, std::uint16_t size, std::uint32_t type,
                     float default_value) {
    appendBig(out, static_cast<std::uint16_t>(name.size()));
    appendText(out, name);
    appendBig(out, size);
    appendBig(out, type);
    for (std::uint16_t i = 0; i < size; ++i) {
        appendBig(out, default_value);
    }
}

std::vector<std::byte> encodeBgeo(const ParticleSet& set) {
    constexpr std::uint32_t kReal = 0;
    constexpr std::uint32_t kVector = 5;
    const bool velocity = !set.velocity.empty();
    const bool colour = !set.colour.empty();
    const bool radius = set.radius > 0.0F;
    const std::uint32_t attributes = (velocity ? 1U : 0U) + (colour ? 1U : 0U) + (radius ? 1U : 0U);
    std::vector<std::byte> out;
    out.reserve(128 + set.count() * (16 + (velocity ? 12U : 0U) + (colour ? 12U : 0U) + (radius ? 4U : 0U)));
    appendText(out, "BgeoV");
    for (const std::uint32_t number :
         {5U, static_cast<std::uint32_t>(set.count()), 0U, 0U, 0U, attributes, 0U, 0U, 0U}) {
        appendBig(out, number);
    }
    if (velocity) {
        appendAttribute(out, "v", 3, kVector, 0.0F);
    }
    if (colour) {
        appendAttribute(out, "Cd", 3, kReal, 1.0F);
    }
    if (radius) {
        appendAttribute(out, "pscale", 1, kReal, set.radius);
    }
    for (std::size_t i = 0; i < set.count(); ++i) {
        appendTriple<std::endian::big>(out, set.position, i);
        appendBig(out, 1.0F);
        if (velocity) {
            appendTriple<std::endian::big>(out, set.velocity, i);
        }
        if (colour) {
            appendTriple<std::endian::big>(out, set.colour, i);
        }
        if (radius) {
            appendBig(out, set.radius);
        }
    }
    out.push_back(std::byte{0x00});
    out.push_back(std::byte{0xFF});
    return out;
}

}  // namespace

Result<std::vector<std::byte>> encode(const ParticleSet& set, Format format, const std::string& name) {
    if (const Status ok = checkSet(set, format, name); !ok) {
        return ok.error();
    }
    switch (format) {
        case Format::pos:
            return encodePos(set);
        case Format::ply:
            return encodePly(set);
        case Format::bgeo:
            return encodeBgeo(set);
        case Format::bgeo_gzip:
            break;
    }
    return deflateGzip(encodeBgeo(set), name);
}

}  // namespace sluice::particles
