// SPDX-License-Identifier: MIT
#include "frame/host_services.hpp"

#include <algorithm>
#include <utility>

#include "share/canary_gl.hpp"
#include "sluice/abi_boundary.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::host {

namespace {

/// Tells the ledger of an image that the renderer brings; unless it is taken, its descriptor is the renderer's again.
class ToldOffer {
  public:
    ToldOffer(ledger::ShareFeed* shares, const SluiceImageExport& image) : shares_(shares), image_(image) {
        if (shares_ != nullptr) {
            shares_->offered(image_);
        }
    }
    ToldOffer(const ToldOffer&) = delete;
    ToldOffer& operator=(const ToldOffer&) = delete;
    ~ToldOffer() {
        if (!taken_ && shares_ != nullptr) {
            shares_->handedBack(image_);
        }
    }
    void taken() { taken_ = true; }

  private:
    ledger::ShareFeed* shares_;
    const SluiceImageExport& image_;
    bool taken_ = false;
};

/// Runs `take`, which consumes the descriptor of `image` if it succeeds and may run out of memory; the ledger hears
/// whose it is then.
template <typename Take>
Status takeOffer(ledger::ShareFeed* shares, const SluiceImageExport& image, const Take& take) {
    ToldOffer offer(shares, image);
    Status status = take();
    if (status) {
        offer.taken();
    }
    return status;
}

/// The image of a canary is gone again, however the canary went.
struct CanaryEnd {
    explicit CanaryEnd(ledger::ShareFeed* feed) : shares(feed) {}
    CanaryEnd(const CanaryEnd&) = delete;
    CanaryEnd& operator=(const CanaryEnd&) = delete;
    ~CanaryEnd() {
        if (shares != nullptr) {
            shares->canaryEnds();
        }
    }
    ledger::ShareFeed* shares;
};

/// The renderer must give back the pointer that came with the services.
Status checkUser(const void* user) {
    if (user == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "user", "it is NULL", "pass SluiceHostServices::user"};
    }
    return {};
}

}  // namespace

HostServices::HostServices(std::function<void(SluiceLogLevel, std::string_view)> log, Trace* trace,
                           ledger::ShareFeed* shares)
    : log_(std::move(log)), trace_(trace), shares_(shares) {
    table_.struct_size = sizeof(table_);
    table_.abi_version = SLUICE_ABI_VERSION;
    table_.user = this;
    table_.log = &HostServices::logService;
    table_.trace = trace != nullptr || shares != nullptr ? &HostServices::traceService : nullptr;
    table_.share_image = &HostServices::shareService;
    table_.retire_image = &HostServices::retireService;
    table_.canary = &HostServices::canaryService;
}

void HostServices::log(SluiceLogLevel level, std::string_view message) {
    if (log_) {
        const std::lock_guard lock(log_mutex_);
        log_(level, message);
    }
}

void HostServices::logService(void* user, std::int32_t level, const char* message) {
    if (user == nullptr || message == nullptr) {
        return;
    }
    static_cast<void>(guarded(nullptr, [&]() -> Status {
        const auto known =
            static_cast<SluiceLogLevel>(std::clamp<std::int32_t>(level, SLUICE_LOG_DEBUG, SLUICE_LOG_ERROR));
        static_cast<HostServices*>(user)->log(known, message);
        return {};
    }));
}

void HostServices::traceService(void* user, const SluiceTraceEvent* event) {
    if (user == nullptr || event == nullptr) {
        return;
    }
    auto& self = *static_cast<HostServices*>(user);
    // The call returns nothing, so the log tells; once, for such a renderer sends every event so.
    if (event->struct_size < kAbiMinimum<SluiceTraceEvent> && !self.short_event_told_.exchange(true)) {
        static_cast<void>(guarded(nullptr, [&]() -> Status {
            self.log(SLUICE_LOG_WARNING, checkAbiStruct(event, "trace event").error().message() +
                                             "; the renderer's events of this size are dropped");
            return {};
        }));
    }
    if (self.trace_ != nullptr) {
        self.trace_->record(*event);
    }
    if (event->struct_size < kAbiMinimum<SluiceTraceEvent>) {
        return;
    }
    if (self.shares_ != nullptr) {
        self.shares_->trace(readAbiStruct(*event));
    }
    if (ledger::HandOffFeed* feed = self.feed_; feed != nullptr) {
        static_cast<void>(guarded(nullptr, [&]() -> Status {
            feed->trace(readAbiStruct(*event));
            return {};
        }));
    }
}

SluiceResult HostServices::shareService(void* user, const SluiceImageExport* image, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (Status status = checkUser(user); !status) {
            return status;
        }
        if (Status status = checkAbiStruct(image, "image"); !status) {
            return status;
        }
        auto& self = *static_cast<HostServices*>(user);
        const SluiceImageExport offer = readAbiStruct(*image);
        return takeOffer(self.shares_, offer, [&]() -> Status {
            Result<ImportedImage> imported = importImage(offer, self.shares_);
            if (!imported) {
                return imported.error();
            }
            self.images_.put(std::move(imported).value());
            return {};
        });
    });
}

void HostServices::retireService(void* user, std::uint32_t role, std::uint32_t image_set) {
    if (user != nullptr) {
        static_cast<HostServices*>(user)->images_.retire(role, image_set);
    }
}

SluiceResult HostServices::canaryService(void* user, const SluiceImageExport* image, std::uint32_t seed,
                                         SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (Status status = checkUser(user); !status) {
            return status;
        }
        if (Status status = checkAbiStruct(image, "image"); !status) {
            return status;
        }
        ledger::ShareFeed* shares = static_cast<HostServices*>(user)->shares_;
        const SluiceImageExport offer = readAbiStruct(*image);
        const CanaryEnd end(shares);
        return takeOffer(shares, offer, [&] { return runCanary(offer, seed, shares); });
    });
}

}  // namespace sluice::host
