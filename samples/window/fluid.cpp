// SPDX-License-Identifier: MIT
#include "fluid.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <glm/common.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <vector>

#include "world.hpp"

namespace window {
namespace {

constexpr float kJetHeight = 0.8F;  // metres above what the jet falls on
constexpr std::uint32_t kMostParticles = 60'000;

void set(float (&to)[3], glm::vec3 from) {
    std::copy_n(glm::value_ptr(from), 3, &to[0]);
}

SluiceBlock block(glm::vec3 low, glm::vec3 high) {
    SluiceBlock out{};
    set(out.low, low);
    set(out.high, high);
    return out;
}

std::vector<SluiceBlock> blocksOf(Preset preset) {
    switch (preset) {
        case Preset::Dam:
            return {block(kLow, {kLow.x + 1.0F, 1.1F, kHigh.z})};
        case Preset::Pool:
            return {block(kLow, {kHigh.x, 0.3F, kHigh.z})};
        default:
            return {};
    }
}

}  // namespace

Fluid::Fluid(Sluice* sluice, const Options& options) : sluice_(sluice), preset_(options.preset) {
    sluice_look_defaults(&settings.look);
    sluice_sky_defaults(&sky_);
    sluice_flow_of(nullptr, &settings.flow, sizeof(settings.flow));
    settings.radius = options.radius;
    heed(sluice_set_sky(sluice_, &sky_));
}

Fluid::~Fluid() {
    sluice_destroy(sluice_);
}

std::unique_ptr<Fluid> Fluid::create(const Options& options, glm::ivec2 size, std::string& why) {
    SluiceOptions asked{};
    sluice_options_defaults(&asked, sizeof(asked));
    asked.width = static_cast<std::uint32_t>(size.x);
    asked.height = static_cast<std::uint32_t>(size.y);
    asked.process = options.isolate ? SLUICE_PROCESS_OWN : SLUICE_PROCESS_SAME;
    // What the log would say of a failed create is what `why` says.
    Sluice* sluice = nullptr;
    if (sluice_create(&asked, &sluice) != SLUICE_OK) {
        why = sluice_last_error(nullptr);
        return nullptr;
    }
    std::unique_ptr<Fluid> fluid(new Fluid(sluice, options));
    fluid->restart();
    why = fluid->trouble_;
    return why.empty() ? std::move(fluid) : nullptr;
}

void Fluid::heed(SluiceResult result) {
    trouble_ = result < 0 ? sluice_last_error(sluice_) : "";
}

void Fluid::restart() {
    SluiceWater water{};
    sluice_water_defaults(&water, sizeof(water));
    water.radius = settings.radius;
    set(water.low, kLow);
    set(water.high, kHigh);
    std::copy_n(&settings.flow.gravity[0], 3, &water.gravity[0]);
    const std::vector<SluiceBlock> blocks = blocksOf(preset_);
    const std::vector<SluiceSolid> stones = solids();
    water.blocks = blocks.data();
    water.block_count = static_cast<std::uint32_t>(blocks.size());
    water.solids = stones.data();
    water.solid_count = static_cast<std::uint32_t>(stones.size());
    // There must be an emitter at the start for one to be opened later; the flow shuts it at once.
    const SluiceEmitter shut = jet({0.0F, 0.0F, 0.0F});
    water.emitters = &shut;
    water.emitter_count = 1;
    water.max_particles = kMostParticles;
    poured_.reset();
    sent_.reset();
    heed(sluice_set_water(sluice_, &water));
}

void Fluid::resize(glm::ivec2 size) {
    heed(sluice_resize(sluice_, static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y)));
}

SluiceEmitter Fluid::jet(glm::vec3 onto) const {
    SluiceEmitter out{};
    out.shape = SLUICE_OPENING_DISC;
    // The whole opening has to lie in the box of the fluid.
    const float reach = 0.5F * settings.jet_width + settings.radius;
    const glm::vec3 above = raised(onto + glm::vec3(0.0F, kJetHeight, 0.0F), reach);
    set(out.centre, glm::clamp(above, kLow + reach, kHigh - reach));
    out.direction[1] = -1.0F;
    out.width = out.height = settings.jet_width;
    out.speed = settings.jet_speed;
    return out;
}

void Fluid::pour(const std::optional<glm::vec3>& onto) {
    poured_ = onto;
}

void Fluid::begin(const Orbit& orbit, glm::ivec2 size, double time) {
    settings.flow.emitter_count = poured_ ? 1 : 0;
    if (poured_) {
        settings.flow.emitters[0] = jet(*poured_);
    }
    heed(sluice_set_look(sluice_, &settings.look));
    if (trouble_.empty() && (!sent_ || std::memcmp(&*sent_, &settings.flow, sizeof(settings.flow)) != 0)) {
        heed(sluice_set_flow(sluice_, &settings.flow));
        sent_ = settings.flow;
    }
    const std::string before = trouble_;
    heed(sluice_begin_frame(sluice_, glm::value_ptr(viewOf(orbit)), glm::value_ptr(projectionOf(size)), time));
    trouble_ = before.empty() ? trouble_ : before;
}

void Fluid::end() {
    const std::string before = trouble_;
    heed(sluice_end_frame(sluice_));
    trouble_ = before.empty() ? trouble_ : before;
}

SluiceStatistics Fluid::statistics() const {
    SluiceStatistics out{};
    out.struct_size = sizeof(out);
    (void)sluice_statistics(sluice_, &out);
    return out;
}

}  // namespace window
