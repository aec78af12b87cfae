// SPDX-License-Identifier: MIT
#include "payload/settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>

namespace sluice::inject {

namespace {

/// The floats of a struct that consists of 32-bit words, in hexadecimal so that no bit is lost.
template <typename T>
std::string words(const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(std::uint32_t) == 0);
    const auto raw = std::bit_cast<std::array<std::uint32_t, sizeof(T) / sizeof(std::uint32_t)>>(value);
    return fmt::format("{:x}", fmt::join(raw, " "));
}

/// The words of a line, one after the other.
class Words {
  public:
    explicit Words(std::string_view text) : rest_(text) {}

    std::string_view next() {
        const std::size_t begin = std::min(rest_.find_first_not_of(' '), rest_.size());
        rest_.remove_prefix(begin);
        const std::string_view word = rest_.substr(0, rest_.find(' '));
        rest_.remove_prefix(word.size());
        return word;
    }
    template <typename T>
    bool read(T& out, int base = 10) {
        const std::string_view word = next();
        T value{};
        std::from_chars_result end{};
        if constexpr (std::is_floating_point_v<T>) {
            end = std::from_chars(word.data(), word.data() + word.size(), value);
        } else {
            end = std::from_chars(word.data(), word.data() + word.size(), value, base);
        }
        if (end.ec != std::errc() || end.ptr != word.data() + word.size()) {
            return false;
        }
        out = value;
        return true;
    }
    void read(Triple& out) {
        Triple value{};
        if (read(value[0]) && read(value[1]) && read(value[2])) {
            out = value;
        }
    }
    template <typename T>
    void readWords(std::optional<T>& out) {
        std::array<std::uint32_t, sizeof(T) / sizeof(std::uint32_t)> raw{};
        for (std::uint32_t& word : raw) {
            if (!read(word, 16)) {
                return;
            }
        }
        out = std::bit_cast<T>(raw);
    }
    [[nodiscard]] std::string_view rest() const { return rest_.empty() ? rest_ : rest_.substr(1); }

  private:
    std::string_view rest_;
};

template <typename T>
void readChoice(Words& line, T& out, int most) {
    int value = 0;
    if (line.read(value) && value >= 0 && value <= most) {
        out = static_cast<T>(value);
    }
}

void readWater(std::string_view key, Words& line, WaterPlan& water) {
    if (key == "water.block") {
        WaterBlock& block = water.blocks.emplace_back();
        line.read(block.low);
        line.read(block.high);
        line.read(block.velocity);
    } else if (key == "water.emitter") {
        std::optional<SluiceEmitter> emitter;
        line.readWords(emitter);
        if (emitter) {
            water.emitters.push_back(*emitter);
        }
    } else if (key == "water.most") {
        line.read(water.max_particles);
    } else if (key == "water.depth") {
        line.read(water.depth_scale);
        line.read(water.depth_thickness);
    } else if (key == "water.from") {
        line.read(water.from_frame);
    } else if (key == "water.world") {
        water.in_view = false;
    } else if (key == "water.units") {
        line.read(water.units_per_metre);
    } else if (key == "water.up") {
        Triple up{};
        line.read(up);
        water.up = up;
    } else if (key == "water.radius") {
        line.read(water.radius);
    } else if (key == "water.low") {
        line.read(water.low);
    } else if (key == "water.high") {
        line.read(water.high);
    } else if (key == "water.gravity") {
        line.read(water.gravity);
    } else if (key == "water.solver") {
        line.read(water.iterations);
        line.read(water.viscosity);
        line.read(water.vorticity);
    }
}

void readPlane(Words& line, std::optional<double>& out) {
    double value = 0;
    if (line.read(value)) {
        out = value;
    }
}

void readLine(std::string_view key, Words& line, Settings& out) {
    if (key == "children") {
        out.children = true;
    } else if (key == "shim") {
        out.shim = line.rest();
    } else if (key == "off") {
        out.off = true;
    } else if (key == "audit") {
        out.audit = true;
    } else if (key == "report") {
        out.report = line.rest();
    } else if (key == "step") {
        line.read(out.step);
    } else if (key == "same-process") {
        out.same_process = true;
    } else if (key == "start-deadline") {
        line.read(out.start_deadline);
    } else if (key == "plugin") {
        out.plugin = line.rest();
    } else if (key == "route") {
        readChoice(line, out.rules.route, static_cast<int>(CameraRoute::Uniforms));
    } else if (key == "overlay") {
        readChoice(line, out.rules.overlay, static_cast<int>(OverlaySwitch::Never));
    } else if (key == "view") {
        readChoice(line, out.rules.view, static_cast<int>(ViewRule::Identity));
    } else if (key == "near") {
        readPlane(line, out.rules.near_plane);
    } else if (key == "far") {
        readPlane(line, out.rules.far_plane);
    } else if (key == "look") {
        line.readWords(out.look);
    } else if (key == "sky") {
        line.readWords(out.sky);
    } else {
        readWater(key, line, out.water);
    }
}

std::string printWater(const WaterPlan& water) {
    std::string text;
    text += water.in_view ? "" : "water.world\n";
    text += water.up ? fmt::format("water.up {}\n", fmt::join(*water.up, " ")) : "";
    text += fmt::format("water.units {}\nwater.radius {}\nwater.low {}\nwater.high {}\nwater.gravity {}\n",
                        water.units_per_metre, water.radius, fmt::join(water.low, " "), fmt::join(water.high, " "),
                        fmt::join(water.gravity, " "));
    text += fmt::format("water.solver {} {} {}\n", water.iterations, water.viscosity, water.vorticity);
    for (const WaterBlock& block : water.blocks) {
        text += fmt::format("water.block {} {} {}\n", fmt::join(block.low, " "), fmt::join(block.high, " "),
                            fmt::join(block.velocity, " "));
    }
    for (const SluiceEmitter& emitter : water.emitters) {
        text += fmt::format("water.emitter {}\n", words(emitter));
    }
    text += water.from_frame == 0 ? "" : fmt::format("water.from {}\n", water.from_frame);
    text += water.max_particles == 0 ? "" : fmt::format("water.most {}\n", water.max_particles);
    text += fmt::format("water.depth {} {}\n", water.depth_scale, water.depth_thickness);
    return text;
}

}  // namespace

std::string printSettings(const Settings& settings) {
    // The shim reads the first two lines itself.
    std::string text = settings.children ? "children\n" : "";
    text += fmt::format("shim {}\n", settings.shim);
    text += settings.off ? "off\n" : "";
    text += settings.audit ? "audit\n" : "";
    text += settings.report.empty() ? "" : fmt::format("report {}\n", settings.report);
    text += settings.step == 0 ? "" : fmt::format("step {}\n", settings.step);
    text += settings.same_process ? "same-process\n" : "";
    text += fmt::format("start-deadline {}\n", settings.start_deadline);
    text += settings.plugin.empty() ? "" : fmt::format("plugin {}\n", settings.plugin);
    text += fmt::format("route {}\noverlay {}\nview {}\n", static_cast<int>(settings.rules.route),
                        static_cast<int>(settings.rules.overlay), static_cast<int>(settings.rules.view));
    if (settings.rules.near_plane) {
        text += fmt::format("near {}\n", *settings.rules.near_plane);
    }
    if (settings.rules.far_plane) {
        text += fmt::format("far {}\n", *settings.rules.far_plane);
    }
    text += printWater(settings.water);
    text += settings.look ? fmt::format("look {}\n", words(*settings.look)) : "";
    text += settings.sky ? fmt::format("sky {}\n", words(*settings.sky)) : "";
    return text;
}

Settings parseSettings(std::string_view text) {
    Settings settings;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        Words words(line);
        const std::string_view key = words.next();
        readLine(key, words, settings);
    }
    return settings;
}

}  // namespace sluice::inject
