// SPDX-License-Identifier: MIT
#include "isolate/simulation_memory.hpp"

#include <cstddef>
#include <type_traits>

#include "sluice/simulation_arrays.hpp"

namespace sluice::isolate {

Result<Mapping> placeArrays(SluiceSimulation& simulation, bool velocities, const UniqueFd& fd) {
    std::size_t length = 0;
    eachArray(simulation, velocities,
              [&](const char* /*name*/, const auto* array, std::size_t elements, std::size_t /*most*/) {
                  length += elements * sizeof(*array);
              });
    Result<Mapping> mapped = mapSealed(fd, length);
    if (!mapped) {
        return mapped;
    }
    const auto* next = static_cast<const std::byte*>(mapped.value().at());
    eachArray(simulation, velocities,
              [&](const char* /*name*/, auto& array, std::size_t elements, std::size_t /*most*/) {
                  using Array = std::remove_reference_t<decltype(array)>;
                  array = elements > 0 ? static_cast<Array>(static_cast<const void*>(next)) : nullptr;
                  next += elements * sizeof(*array);
              });
    return mapped;
}

}  // namespace sluice::isolate
