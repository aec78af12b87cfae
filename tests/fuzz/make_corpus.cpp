// SPDX-License-Identifier: MIT
// Writes the seeds of the fuzz corpus: make_corpus FOLDER. Small sets in every shape that the parsers know.
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bytes.hpp"
#include "encode.hpp"
#include "gzip.hpp"
#include "isolate_samples.hpp"
#include "ledger_seeds.hpp"
#include "sluice/particles/generate.hpp"

namespace {

using sluice::particles::Format;
using sluice::particles::ParticleSet;
using File = std::vector<std::byte>;

bool write(const std::filesystem::path& path, const File& file) {
    std::filesystem::create_directories(path.parent_path());
    std::FILE* out = std::fopen(path.c_str(), "wb");
    if (out == nullptr) {
        return false;
    }
    const bool whole = std::fwrite(file.data(), 1, file.size(), out) == file.size();
    return std::fclose(out) == 0 && whole;
}

/// The first particles of a generated pool.
ParticleSet somePool(std::size_t count, bool velocity, bool colour) {
    ParticleSet set = sluice::particles::generatePool(1000, 1, 0.2).value();
    set.position.resize(3 * count);
    set.velocity.resize(velocity ? 3 * count : 0);
    for (std::size_t i = 0; colour && i < 3 * count; ++i) {
        set.colour.push_back(static_cast<float>(i % 5) / 4.0F);
    }
    return set;
}

File text(std::string_view characters) {
    File file;
    sluice::particles::appendText(file, characters);
    return file;
}

/// As Partio writes: an integer, an index with its strings, a detail attribute, the extra section.
File bgeoOfManyKinds() {
    using sluice::particles::appendBig;
    using sluice::particles::appendText;
    File file = text("BgeoV");
    for (const std::uint32_t number : {5U, 1U, 0U, 0U, 0U, 2U, 0U, 0U, 1U}) {
        appendBig(file, number);
    }
    const auto define = [&file](std::string_view name, std::uint32_t type) {
        appendBig(file, static_cast<std::uint16_t>(name.size()));
        appendText(file, name);
        appendBig(file, std::uint16_t{1});
        appendBig(file, type);
    };
    define("id", 1);
    appendBig(file, std::uint32_t{0});
    define("material", 4);
    appendBig(file, std::uint32_t{1});
    appendBig(file, std::uint16_t{5});
    appendText(file, "water");
    for (const float value : {0.5F, 1.0F, -0.5F, 1.0F}) {
        appendBig(file, value);
    }
    appendBig(file, std::uint32_t{7});
    appendBig(file, std::uint32_t{0});
    define("pscale", 0);
    appendBig(file, 0.0F);
    appendBig(file, 0.025F);
    file.push_back(std::byte{0x00});
    file.push_back(std::byte{0xFF});
    return file;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: make_corpus FOLDER\n", stderr);
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    bool ok = true;
    const auto put = [&](const char* name, const File& file) { ok = write(folder / name, file) && ok; };
    const auto encoded = [](const ParticleSet& set, Format format) {
        return sluice::particles::encode(set, format, "seed").value();
    };
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{5}}) {
        const std::string number = std::to_string(count);
        put(("pos/pool-" + number).c_str(), encoded(somePool(count, false, false), Format::pos));
        put(("ply/binary-" + number).c_str(), encoded(somePool(count, true, true), Format::ply));
        put(("bgeo/plain-" + number).c_str(), encoded(somePool(count, true, true), Format::bgeo));
        put(("bgeo/gzip-" + number).c_str(), encoded(somePool(count, true, false), Format::bgeo_gzip));
    }
    File cut = encoded(somePool(5, true, true), Format::pos);
    cut.resize(cut.size() - 5);
    put("pos/cut", cut);
    put("pos/empty", {});
    put("ply/ascii-lists",
        text("ply\nformat ascii 1.0\ncomment c\nobj_info radius 0.02\nelement face 2\nproperty list uchar int i\n"
             "element vertex 2\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty double x\n"
             "property short y\nproperty float z\nproperty float radius\nend_header\n3 0 1 2\n0\n255 128 0 1.5 -2 3e-3 "
             "0.1\n"
             "0 0 0 +1 2 3 0.2\n"));
    put("ply/ascii-velocity",
        text("ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\nproperty float "
             "z\r\n"
             "property float velocity_x\r\nproperty float velocity_y\r\nproperty float velocity_z\r\nend_header\r\n"
             "1 2 3 4 5 6\r\n"));
    put("ply/big-endian", text("ply\nformat binary_big_endian 1.0\nelement vertex 0\nend_header\n"));
    put("bgeo/many-kinds", bgeoOfManyKinds());
    put("bgeo/json", text("\x7fNSJb"));
    ok = sluice::fuzz::writeLedgerSeeds(folder / "ledger_log") && ok;
    for (const sluice::isolate::Message& message : sluice::isolate::test::sampleMessages()) {
        const std::string name(sluice::isolate::nameOf(message));
        put(("isolate/" + name).c_str(),
            sluice::isolate::encode(message, 1, sluice::isolate::test::descriptorsOf(message)));
    }
    if (!ok) {
        std::fprintf(stderr, "make_corpus: cannot write into %s\n", folder.c_str());
        return 1;
    }
    return 0;
}
