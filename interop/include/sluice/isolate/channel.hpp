// SPDX-License-Identifier: MIT
// One end of the socket between a host and its renderer's process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sluice/fd.hpp"
#include "sluice/isolate/messages.hpp"
#include "sluice/result.hpp"

namespace sluice::isolate {

inline constexpr std::uint64_t kForever = UINT64_MAX;

struct Received {
    std::uint64_t call = 0;
    Message message;
    std::vector<UniqueFd> fds;  ///< as many as the kind carries; close-on-exec
};

/// A message as it came, whatever it says.
struct Packet {
    std::vector<std::byte> bytes;
    std::vector<UniqueFd> fds;  ///< close-on-exec
};

/// A Unix socket of whole messages (SOCK_SEQPACKET) with descriptors beside them. Any number of threads may send, one
/// at a time may receive.
class Channel {
  public:
    Channel() = default;
    explicit Channel(UniqueFd socket) : socket_(std::move(socket)) {}

    /// Two ends that know each other, both close-on-exec.
    [[nodiscard]] static Result<std::pair<Channel, Channel>> pair();

    /// `fds` stay the caller's: the other side gets descriptors of its own. SLUICE_TIMEOUT when there was no room in
    /// time, SLUICE_ERROR_DEVICE_LOST when the other end is closed.
    [[nodiscard]] Status send(const Message& message, std::uint64_t call, std::span<const int> fds,
                              std::uint64_t timeout_ns) const;
    /// SLUICE_TIMEOUT when nothing came in time, SLUICE_ERROR_DEVICE_LOST when the other end is closed and everything
    /// that it sent was received, SLUICE_ERROR_INVALID_ARGUMENT for a message that is none. Whatever descriptors came
    /// with that are closed.
    [[nodiscard]] Result<Received> receive(std::uint64_t timeout_ns) const;
    /// The same for messages of the caller's own, of at most kMaxMessage bytes and 8 descriptors.
    [[nodiscard]] Status sendBytes(std::span<const std::byte> bytes, std::span<const int> fds,
                                   std::uint64_t timeout_ns) const;
    [[nodiscard]] Result<Packet> receiveBytes(std::uint64_t timeout_ns) const;
    /// The other end's receive ends, and so does any here. The descriptor stays open.
    void shutdown() const;
    /// After a send that found the other end closed: whether it is closed in both directions, as it is when its process
    /// has ended. Waits for that, but not longer than `timeout_ns`. False: it is open and receives no more.
    [[nodiscard]] bool closedThere(std::uint64_t timeout_ns) const;
    [[nodiscard]] int fd() const { return socket_.get(); }

  private:
    UniqueFd socket_;
};

}  // namespace sluice::isolate
