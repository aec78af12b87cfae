// SPDX-License-Identifier: MIT
// Crossing the C ABI: Errors become messages, exceptions become Errors.
#pragma once

#include <exception>
#include <new>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice {

/// Fills `to`, cut to what its struct_size holds; NULL is allowed. Says something even where `error` has no text.
void writeAbiError(SluiceError* to, const Error& error) noexcept;

/// There is no error struct, or one that holds every message whole. If not, what fits has been written to it.
[[nodiscard]] bool usableError(SluiceError* error) noexcept;

/// Runs `body`, which returns a Status; nothing is thrown. An unusable `error` is an invalid argument, and `body` is
/// not run.
template <typename Body>
[[nodiscard]] SluiceResult guarded(SluiceError* error, Body body) noexcept {
    if (!usableError(error)) {
        return SLUICE_ERROR_INVALID_ARGUMENT;
    }
    try {
        const Status status = body();
        if (status) {
            return SLUICE_OK;
        }
        writeAbiError(error, status.error());
        return status.error().code;
    } catch (const std::bad_alloc&) {
        const Error failure{SLUICE_ERROR_OUT_OF_MEMORY, {}, {}, {}};
        writeAbiError(error, failure);
        return failure.code;
    } catch (const std::exception& thrown) {
        try {
            writeAbiError(error, {SLUICE_ERROR_INTERNAL, "exception", thrown.what(), {}});
        } catch (...) {
            writeAbiError(error, {SLUICE_ERROR_INTERNAL, {}, {}, {}});
        }
        return SLUICE_ERROR_INTERNAL;
    } catch (...) {
        writeAbiError(error, {SLUICE_ERROR_INTERNAL, {}, {}, {}});
        return SLUICE_ERROR_INTERNAL;
    }
}

}  // namespace sluice
