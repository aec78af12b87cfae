// SPDX-License-Identifier: MIT
#include "stress/chain.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "stress/chance.hpp"

namespace sluice::stress {
namespace {

constexpr std::uint32_t kNoWord = 0xFFFFFFFF;
constexpr float kTwo24 = 16'777'216.0F;
constexpr std::size_t kRemembered = 6;  ///< versions per slot; a stale texel of a ring is one or two rounds old

std::uint32_t wordOfFloat(float value, float scale) {
    const float scaled = value * scale;  // a power of two: exact
    if (!(scaled >= 0.0F && scaled < kTwo24) || scaled != std::floor(scaled)) {
        return kNoWord;
    }
    return static_cast<std::uint32_t>(scaled);
}

}  // namespace

std::uint32_t wordMask(Resource resource) {
    return resource == Resource::D32F || resource == Resource::R32F ? 0xFFFFFFU : 0xFFFFFFFFU;
}

std::uint32_t mix(std::uint32_t x, std::uint32_t input, std::uint32_t salt, std::uint32_t index, std::uint32_t mask) {
    x = (x * 0x9E3779B1U + input) & mask;
    x = (x ^ (salt + index * 0x85EBCA6BU)) & mask;
    x = (x * 0xC2B2AE35U) & mask;
    x ^= x >> 11U;
    x = (x * 0x27D4EB2FU) & mask;
    x ^= x >> 13U;
    return x;
}

std::uint32_t saltOf(std::uint64_t seed, std::uint64_t turn) {
    return static_cast<std::uint32_t>(Chance(seed + turn * 0x9E3779B97F4A7C15ULL).next());
}

Words decode(Resource resource, std::span<const std::byte> texels) {
    Words words(texels.size() / 4);
    std::memcpy(words.data(), texels.data(), words.size() * 4);
    if (resource == Resource::D32F || resource == Resource::R32F) {
        for (std::uint32_t& word : words) {
            float value = 0.0F;
            std::memcpy(&value, &word, sizeof(value));
            word = wordOfFloat(value, resource == Resource::D32F ? kTwo24 : 1.0F);
        }
    }
    return words;
}

void Model::restart(Resource resource, std::uint32_t texels, std::uint32_t slots) {
    mask_ = wordMask(resource);
    texels_ = texels;
    slots_.assign(slots, {});
}

void Model::apply(const Turn& turn) {
    Version made{turn.version, Words(texels_)};
    for (std::uint32_t index = 0; index < texels_; ++index) {
        std::uint32_t x = turn.inputs.empty() ? mix(0, 0, turn.salt, index, mask_) : 0;
        for (std::uint32_t j = 0; j < turn.inputs.size(); ++j) {
            const auto& input = slots_[turn.inputs[j]];
            x = mix(x, input.empty() ? 0 : input.back().words[index], turn.salt + j, index, mask_);
        }
        made.words[index] = x;
    }
    auto& slot = slots_[turn.output];
    if (slot.size() == kRemembered) {
        std::rotate(slot.begin(), slot.begin() + 1, slot.end());
        slot.pop_back();
    }
    slot.push_back(std::move(made));
}

Finding Model::compare(std::uint32_t slot, const Words& found, std::uint64_t& bad, std::uint64_t& found_version) const {
    const auto& versions = slots_[slot];
    bad = 0;
    found_version = 0;
    if (versions.empty()) {
        return Finding::Right;
    }
    found_version = versions.back().number;
    const Words& expected = versions.back().words;
    if (found.size() != expected.size()) {
        bad = expected.size();
        return Finding::Wrong;
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
        bad += found[i] != expected[i] ? 1U : 0U;
    }
    if (bad == 0) {
        return Finding::Right;
    }
    const auto whole = std::find_if(versions.rbegin(), versions.rend(),
                                    [&](const Version& version) { return version.words == found; });
    if (whole != versions.rend()) {
        found_version = whole->number;
        return Finding::Stale;
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (std::none_of(versions.begin(), versions.end(),
                         [&](const Version& version) { return version.words[i] == found[i]; })) {
            return Finding::Wrong;
        }
    }
    return Finding::Torn;
}

}  // namespace sluice::stress
