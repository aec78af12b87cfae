// SPDX-License-Identifier: MIT
#include "program.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

namespace sluice::test {

void ProgramTest::SetUp() {
    std::string name = (std::filesystem::temp_directory_path() / "sluice-cli-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
}

void ProgramTest::TearDown() {
    std::filesystem::remove_all(folder_);
}

Outcome ProgramTest::run(const std::string& words, const std::string& wrapper) const {
    const std::filesystem::path out = folder_.string() + ".out";
    const std::filesystem::path err = folder_.string() + ".err";
    const std::string command =
        fmt::format("cd '{}' && unset SLUICE_PLUGIN && {} '{}' {} >'{}' 2>'{}'", folder_.string(), wrapper,
                    SLUICE_PROGRAM, words, out.string(), err.string());
    const int status = std::system(command.c_str());
    const auto slurp = [](const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        return std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    };
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), slurp(out), slurp(err)};
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return outcome;
}

void ProgramTest::write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories(at(name).parent_path());
    std::ofstream(at(name), std::ios::binary) << bytes;
}

std::string ProgramTest::read(const std::string& name) const {
    std::ifstream file(at(name), std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<std::string> ProgramTest::files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

void ProgramTest::writeParticles(const std::string& name, unsigned n) const {
    std::string bytes;
    const auto append = [&bytes](const auto& value) {
        char raw[sizeof(value)];
        std::memcpy(&raw[0], &value, sizeof(value));
        bytes.append(&raw[0], sizeof(value));
    };
    const float spacing = 1.0F / static_cast<float>(n);
    append(static_cast<std::uint32_t>(n * n * n));
    append(spacing / 2.0F);
    for (unsigned i = 0; i < n * n * n; ++i) {
        const unsigned row = i / n;
        const unsigned layer = row / n;
        append((static_cast<float>(i % n) + 0.5F) * spacing - 0.5F);
        append((static_cast<float>(row % n) + 0.5F) * spacing);
        append((static_cast<float>(layer) + 0.5F) * spacing - 0.5F);
    }
    write(name, bytes);
}

void ProgramTest::writeScene(const std::string& name, const std::string& particles, const std::string& more) const {
    write(name, fmt::format(R"({{"particles": {{"path": "{}"}}, "size": [160, 90],
        "camera": {{"position": [-2, 2, -1.5], "target": [0, 0.5, 0]}}{}}})",
                            particles, more));
}

}  // namespace sluice::test
