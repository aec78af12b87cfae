// SPDX-License-Identifier: MIT
// Classic Houdini .bgeo, version 5, as Houdini (.bhclassic), Partio and SPlisHSPlasH write it. Everything is
// big-endian:
//   'Bgeo' 'V' i32 version; i32 points, primitives, point groups, primitive groups, point / vertex / primitive / detail
//   attributes; point attribute definitions; per point f32 x y z w and 32 bits per attribute value; and, when there are
//   no primitives and no groups, vertex, primitive and detail definitions, the detail values, and an "extra" section 00
//   ... FF.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "bgeo_attributes.hpp"
#include "builder.hpp"
#include "gzip.hpp"

namespace sluice::particles {

namespace {

using bgeo::Attribute;
using bgeo::Cursor;
using bgeo::Kind;

constexpr std::uint64_t kPosition = 16;  // x y z w

struct Counts {
    std::uint32_t points, primitives, point_groups, primitive_groups;
    std::uint32_t point_attributes, vertex_attributes, primitive_attributes, detail_attributes;
    [[nodiscard]] bool onlyPoints() const { return primitives == 0 && point_groups == 0 && primitive_groups == 0; }
};

/// The attributes that mean something here; null if the file has none.
struct Sources {
    const Attribute* velocity = nullptr;
    const Attribute* colour = nullptr;
    const Attribute* radius = nullptr;
};

Status checkMagic(Cursor& cursor) {
    const std::string_view text = asText(cursor.bytes);
    if (text.empty()) {
        return failure(cursor.name, atByte(0), "'BgeoV'", "an empty file",
                       "the file was never written; export it again");
    }
    // Houdini 12 and later write JSON: as text, or as binary JSON with the magic 7F 'NSJb'.
    if (text.starts_with("\x7fNSJ") || text.starts_with('[') || text.starts_with('{')) {
        return failure(
            cursor.name, cursor.place(0), "classic bgeo ('BgeoV', version 5)", "Houdini's JSON geometry",
            "save it from Houdini with the ending .bhclassic, or convert it: gconvert in.bgeo out.bhclassic");
    }
    if (text.starts_with("scf1")) {
        return failure(cursor.name, cursor.place(0), "classic bgeo ('BgeoV', version 5)",
                       "Blosc compression (.bgeo.sc)", "save it from Houdini with the ending .bhclassic");
    }
    if (!text.starts_with("BgeoV")) {
        return failure(cursor.name, cursor.place(0), "'BgeoV'", printable(text.substr(0, 5)),
                       "this is no classic bgeo file");
    }
    cursor.at = 5;
    const Result<std::uint32_t> version = cursor.take<std::uint32_t>("the version");
    if (!version) {
        return version.error();
    }
    if (version.value() != 5) {
        return failure(cursor.name, cursor.place(5), "version 5", fmt::format("version {}", version.value()));
    }
    return {};
}

Result<Counts> readCounts(Cursor& cursor) {
    std::array<std::uint32_t, 8> number{};
    constexpr std::array<const char*, 8> kNames{
        "points",           "primitives",        "point groups",         "primitive groups",
        "point attributes", "vertex attributes", "primitive attributes", "detail attributes"};
    for (std::size_t i = 0; i < number.size(); ++i) {
        const std::size_t at = cursor.at;
        const Result<std::uint32_t> value = cursor.take<std::uint32_t>(fmt::format("the number of {}", kNames[i]));
        if (!value) {
            return value.error();
        }
        if (value.value() > 0x7FFFFFFFU) {
            return failure(cursor.name, cursor.place(at), fmt::format("a number of {} from 0", kNames[i]),
                           fmt::format("{}", static_cast<std::int32_t>(value.value())), "the header is damaged");
        }
        number[i] = value.value();
    }
    if (const Status ok = checkCount(cursor.name, number[0], cursor.place(9)); !ok) {
        return ok.error();
    }
    return Counts{number[0], number[1], number[2], number[3], number[4], number[5], number[6], number[7]};
}

const Attribute* find(const std::vector<Attribute>& attributes, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) {
        const auto found = std::ranges::find(attributes, name, &Attribute::name);
        if (found != attributes.end()) {
            return &*found;
        }
    }
    return nullptr;
}

/// An attribute that has a known name must have the shape that the name promises.
Status checkShape(const Cursor& cursor, const Attribute* attribute, std::uint32_t size) {
    if (attribute == nullptr ||
        (attribute->size == size && (attribute->kind == Kind::real || attribute->kind == Kind::vector))) {
        return {};
    }
    return failure(cursor.name, cursor.place(attribute->place),
                   fmt::format("attribute {} as {} float{}", printable(attribute->name), size, size == 1 ? "" : "s"),
                   fmt::format("{} of type {}", attribute->size, static_cast<int>(attribute->kind)));
}

Result<Sources> findSources(const Cursor& cursor, const std::vector<Attribute>& attributes) {
    const Sources sources{find(attributes, {"v", "velocity"}), find(attributes, {"Cd", "color", "colour"}),
                          find(attributes, {"pscale", "radius"})};
    for (const auto& [attribute, size] :
         {std::pair{sources.velocity, 3U}, std::pair{sources.colour, 3U}, std::pair{sources.radius, 1U}}) {
        if (const Status ok = checkShape(cursor, attribute, size); !ok) {
            return ok.error();
        }
    }
    return sources;
}

Triple readTriple(const Cursor& cursor, std::size_t at) {
    const std::byte* from = cursor.bytes.data() + at;
    return {readBig<float>(from), readBig<float>(from + 4), readBig<float>(from + 8)};
}

/// One record; `at` is its first byte.
Status readPoint(const Cursor& cursor, std::size_t at, const Sources& sources, Builder& builder) {
    if (Status ok = builder.addPosition(readTriple(cursor, at), cursor.place(at)); !ok) {
        return ok;
    }
    if (sources.velocity != nullptr) {
        const std::size_t from = at + sources.velocity->offset;
        if (Status ok = builder.addVelocity(readTriple(cursor, from), cursor.place(from)); !ok) {
            return ok;
        }
    }
    if (sources.colour != nullptr) {
        const std::size_t from = at + sources.colour->offset;
        if (Status ok = builder.addColour(readTriple(cursor, from), cursor.place(from)); !ok) {
            return ok;
        }
    }
    if (sources.radius != nullptr) {
        const std::size_t from = at + sources.radius->offset;
        return builder.addRadius(readBig<float>(cursor.bytes.data() + from), cursor.place(from));
    }
    return {};
}

Status readPoints(Cursor& cursor, const Counts& counts, Builder& builder) {
    const Result<std::vector<Attribute>> attributes =
        readAttributes(cursor, counts.point_attributes, kPosition, "point");
    if (!attributes) {
        return attributes.error();
    }
    const Result<Sources> sources = findSources(cursor, attributes.value());
    if (!sources) {
        return sources.error();
    }
    const std::uint64_t stride = recordSize(attributes.value(), kPosition);
    if (cursor.left() / stride < counts.points) {
        return failure(cursor.name, cursor.place(cursor.at),
                       fmt::format("{} points of {} bytes", counts.points, stride),
                       fmt::format("{} bytes to the end of the file", cursor.left()), "the file is cut short");
    }
    // Without points, the default of pscale is the only radius that the file can tell.
    const Attribute* radius = sources.value().radius;
    if (counts.points == 0 && radius != nullptr && usableRadius(radius->defaults.at(0))) {
        if (Status ok = builder.setRadius(radius->defaults[0], cursor.place(radius->place)); !ok) {
            return ok;
        }
    }
    builder.reserve(counts.points, sources.value().velocity != nullptr, sources.value().colour != nullptr);
    for (std::uint32_t i = 0; i < counts.points; ++i, cursor.at += stride) {
        if (Status ok = readPoint(cursor, cursor.at, sources.value(), builder); !ok) {
            return ok;
        }
    }
    return {};
}

/// What follows the points when there are no primitives and no groups; a radius may be among the detail attributes.
Status readRest(Cursor& cursor, const Counts& counts, Builder& builder, bool has_radius) {
    for (const auto& [count, of] :
         {std::pair{counts.vertex_attributes, "vertex"}, std::pair{counts.primitive_attributes, "primitive"}}) {
        if (const auto unused = readAttributes(cursor, count, 0, of); !unused) {
            return unused.error();
        }
    }
    const Result<std::vector<Attribute>> detail = readAttributes(cursor, counts.detail_attributes, 0, "detail");
    if (!detail) {
        return detail.error();
    }
    const std::uint64_t size = recordSize(detail.value(), 0);
    if (Status ok = cursor.need(size, "the values of the detail attributes"); !ok) {
        return ok;
    }
    const Attribute* radius = find(detail.value(), {"pscale", "radius"});
    if (Status ok = checkShape(cursor, radius, 1); !ok) {
        return ok;
    }
    if (radius != nullptr && !has_radius) {
        const std::size_t from = cursor.at + radius->offset;
        if (Status ok = builder.setRadius(readBig<float>(cursor.bytes.data() + from), cursor.place(from)); !ok) {
            return ok;
        }
    }
    cursor.at += size;
    const bool extra =
        cursor.left() >= 2 && cursor.bytes[cursor.at] == std::byte{0} && cursor.bytes.back() == std::byte{0xFF};
    if (cursor.left() != 0 && !extra) {
        return failure(
            cursor.name, cursor.place(cursor.at), "the end of the file or the extra section 00 … ff",
            fmt::format("{} bytes from {}", cursor.left(), printable(asText(cursor.bytes.subspan(cursor.at)))),
            "the header's counts do not match the data");
    }
    return {};
}

Result<ParticleSet> parsePlain(Bytes bytes, const std::string& name, Place::Unit unit) {
    Cursor cursor{bytes, name, unit};
    if (const Status ok = checkMagic(cursor); !ok) {
        return ok.error();
    }
    const Result<Counts> counts = readCounts(cursor);
    if (!counts) {
        return counts.error();
    }
    Builder builder(name);
    if (const Status ok = readPoints(cursor, counts.value(), builder); !ok) {
        return ok.error();
    }
    if (counts.value().onlyPoints()) {
        if (const Status ok = readRest(cursor, counts.value(), builder, builder.hasRadius()); !ok) {
            return ok.error();
        }
    }
    return builder.finish();
}

}  // namespace

Result<ParticleSet> parseBgeo(std::span<const std::byte> bytes, const std::string& name) {
    if (!looksLikeGzip(bytes)) {
        return parsePlain(bytes, name, Place::Unit::byte);
    }
    const Result<std::vector<std::byte>> inflated = inflateGzip(bytes, name, inflateLimit(bytes.size()));
    if (!inflated) {
        return inflated.error();
    }
    return parsePlain(inflated.value(), name, Place::Unit::inflated_byte);
}

}  // namespace sluice::particles
