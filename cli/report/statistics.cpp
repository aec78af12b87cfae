// SPDX-License-Identifier: MIT
#include "report/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace sluice::cli {

double median(std::vector<double> values) {
    if (values.empty()) {
        return 0.0;
    }
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2.0;
}

double maximum(const std::vector<double>& values) {
    return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

void PassStatistics::add(const SluiceFrameStats& stats) {
    std::vector<bool> begun(passes_.size(), false);
    for (std::uint32_t i = 0; i < std::min(stats.pass_count, SLUICE_MAX_PASSES); ++i) {
        const SluicePassStats& pass = stats.passes[i];
        const auto found = std::find_if(passes_.begin(), passes_.end(),
                                        [&pass](const Samples& known) { return known.name == pass.name; });
        const auto index = static_cast<std::size_t>(found - passes_.begin());
        if (found == passes_.end()) {
            passes_.push_back({pass.name, 0, pass.is_particles != 0, {}, {}, {}, {}});
            begun.push_back(false);
        }
        Samples& samples = passes_[index];
        if (!begun[index]) {
            begun[index] = true;
            samples.ms.push_back(0.0);
            samples.elements.push_back(0.0);
            samples.bytes.push_back(0.0);
            samples.dispatches.push_back(0.0);
        }
        samples.calls += 1;
        samples.ms.back() += static_cast<double>(pass.nanoseconds) * 1.0e-6;
        samples.elements.back() += static_cast<double>(pass.elements);
        samples.bytes.back() += static_cast<double>(pass.bytes);
        samples.dispatches.back() += pass.dispatches;
    }
}

std::vector<PassRow> PassStatistics::rows() const {
    std::vector<PassRow> rows;
    for (const Samples& pass : passes_) {
        const auto [low, high] = std::minmax_element(pass.ms.begin(), pass.ms.end());
        rows.push_back({pass.name, pass.calls, pass.ms.size(), median(pass.ms), *low, *high,
                        static_cast<std::uint64_t>(maximum(pass.elements)),
                        static_cast<std::uint64_t>(maximum(pass.bytes)),
                        static_cast<std::uint64_t>(median(pass.dispatches)), pass.particles});
    }
    return rows;
}

void addCopies(CopyBytes& sum, const std::vector<TraceRecord>& records) {
    for (const TraceRecord& record : records) {
        if (record.kind != SLUICE_TRACE_CPU_COPY) {
            continue;
        }
        const std::string_view name = record.name.data();
        if (name.starts_with("read")) {
            sum.readback += record.bytes;
        } else if (name.find("upload") != std::string_view::npos) {
            sum.upload += record.bytes;
        } else {
            sum.shared_images += record.bytes;
        }
    }
}

double waitMilliseconds(const std::vector<TraceRecord>& records) {
    double sum = 0.0;
    for (const TraceRecord& record : records) {
        if (record.kind == SLUICE_TRACE_WAIT &&
            (record.track == SLUICE_TRACK_HOST_CPU || record.track == SLUICE_TRACK_HOST_GL)) {
            sum += static_cast<double>(record.duration_ns) * 1.0e-6;
        }
    }
    return sum;
}

}  // namespace sluice::cli
