// SPDX-License-Identifier: MIT
#include "sluice/isolate/channel.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "sluice/isolate/above_streams.hpp"
#include "sluice/trace.hpp"

namespace sluice::isolate {

namespace {

constexpr const char* kThing = "channel between host and renderer";
/// Room for more descriptors than any message carries, so that a surplus is seen and closed here.
constexpr std::size_t kFdRoom = 8;

Error closed() {
    return {SLUICE_ERROR_DEVICE_LOST, kThing, "the other process has closed it", "start the renderer again"};
}

Error systemError(const char* call) {
    const int number = errno;
    return {SLUICE_ERROR_INTERNAL, kThing, fmt::format("{}: {}", call, std::strerror(number)), ""};
}

Error late(const char* what, std::uint64_t timeout_ns) {
    return {SLUICE_TIMEOUT, kThing, fmt::format("{} within {:.3f} s", what, static_cast<double>(timeout_ns) * 1e-9),
            "the other process hangs or is slow"};
}

/// Waits for `events` or the end of the peer. False: the time has passed.
Result<bool> ready(int fd, short events, std::uint64_t deadline_ns) {
    for (;;) {
        const std::uint64_t now = monotonicNanoseconds();
        const std::uint64_t left = deadline_ns == kForever ? kForever : deadline_ns - std::min(now, deadline_ns);
        pollfd entry{fd, events, 0};
        // Rounded up, so that the last look comes after the deadline and not in a busy loop before it.
        const int wait_ms =
            left == kForever ? -1 : static_cast<int>(std::min<std::uint64_t>((left + 999'999) / 1'000'000, 3'600'000));
        const int found = ::poll(&entry, 1, wait_ms);
        if (found > 0) {
            return true;
        }
        if (found < 0 && errno != EINTR) {
            return systemError("poll");
        }
        if (found == 0 && left != kForever && monotonicNanoseconds() >= deadline_ns) {
            return false;
        }
    }
}

/// Whether the other end sends no more; a message without a byte looks the same to recvmsg.
bool hungUp(int fd) {
    pollfd entry{fd, POLLRDHUP, 0};
    return ::poll(&entry, 1, 0) != 0;
}

std::uint64_t deadlineAfter(std::uint64_t timeout_ns) {
    const std::uint64_t now = monotonicNanoseconds();
    return timeout_ns > kForever - now ? kForever : now + timeout_ns;
}

union ControlRoom {
    cmsghdr align;
    std::array<char, CMSG_SPACE(kFdRoom * sizeof(int))> bytes;
};

std::vector<UniqueFd> takeDescriptors(msghdr& header) {
    std::vector<UniqueFd> fds;
    fds.reserve(kFdRoom);  // nothing may fail between the first descriptor and the last
    for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
        if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) {
            continue;
        }
        const std::size_t count = (part->cmsg_len - CMSG_LEN(0)) / sizeof(int);
        for (std::size_t i = 0; i < count; ++i) {
            int fd = -1;
            std::memcpy(&fd, CMSG_DATA(part) + i * sizeof(int), sizeof(fd));
            fds.emplace_back(fd);
        }
    }
    return fds;
}

}  // namespace

Result<std::pair<Channel, Channel>> Channel::pair() {
    std::array<int, 2> ends{-1, -1};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        return systemError("socketpair");
    }
    UniqueFd here(ends[0]);
    UniqueFd there(ends[1]);
    here = aboveStreams(std::move(here));
    there = aboveStreams(std::move(there));
    if (!here.valid() || !there.valid()) {
        return systemError("fcntl(F_DUPFD_CLOEXEC)");
    }
    return std::pair(Channel(std::move(here)), Channel(std::move(there)));
}

Status Channel::send(const Message& message, std::uint64_t call, std::span<const int> fds,
                     std::uint64_t timeout_ns) const {
    const std::vector<std::byte> bytes = encode(message, call, static_cast<std::uint32_t>(fds.size()));
    if (bytes.size() > kMaxMessage || fds.size() > kFdRoom) {
        return Error{
            SLUICE_ERROR_INVALID_ARGUMENT, kThing,
            fmt::format("a {} of {} bytes and {} descriptors is too long", nameOf(message), bytes.size(), fds.size()),
            ""};
    }
    return sendBytes(bytes, fds, timeout_ns);
}

Status Channel::sendBytes(std::span<const std::byte> bytes, std::span<const int> fds, std::uint64_t timeout_ns) const {
    if (bytes.size() > kMaxMessage || fds.size() > kFdRoom) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, kThing,
                     fmt::format("{} bytes and {} descriptors are too long a message", bytes.size(), fds.size()), ""};
    }
    iovec data{const_cast<std::byte*>(bytes.data()), bytes.size()};  // only read
    ControlRoom control{};
    msghdr header{};
    header.msg_iov = &data;
    header.msg_iovlen = 1;
    if (!fds.empty()) {
        header.msg_control = &control;
        header.msg_controllen = CMSG_SPACE(fds.size_bytes());
        cmsghdr* part = CMSG_FIRSTHDR(&header);
        part->cmsg_level = SOL_SOCKET;
        part->cmsg_type = SCM_RIGHTS;
        part->cmsg_len = CMSG_LEN(fds.size_bytes());
        std::memcpy(CMSG_DATA(part), fds.data(), fds.size_bytes());
    }
    const std::uint64_t deadline = deadlineAfter(timeout_ns);
    for (;;) {
        if (::sendmsg(socket_.get(), &header, MSG_NOSIGNAL | MSG_DONTWAIT) >= 0) {
            return {};
        }
        if (errno == EPIPE || errno == ECONNRESET) {
            return closed();
        }
        if (errno != EAGAIN && errno != EINTR) {
            return systemError("sendmsg");
        }
        if (errno == EAGAIN) {
            const Result<bool> room = ready(socket_.get(), POLLOUT, deadline);
            if (!room) {
                return room.error();
            }
            if (!room.value()) {
                return late("no room for a message", timeout_ns);
            }
        }
    }
}

Result<Received> Channel::receive(std::uint64_t timeout_ns) const {
    Result<Packet> packet = receiveBytes(timeout_ns);
    if (!packet) {
        return packet.error();
    }
    std::vector<UniqueFd> fds = std::move(packet.value().fds);
    Result<Decoded> decoded = decode(packet.value().bytes, static_cast<std::uint32_t>(fds.size()));
    if (!decoded) {
        return decoded.error();
    }
    return Received{decoded.value().call, std::move(decoded.value().message), std::move(fds)};
}

Result<Packet> Channel::receiveBytes(std::uint64_t timeout_ns) const {
    const std::uint64_t deadline = deadlineAfter(timeout_ns);
    std::array<std::byte, kMaxMessage> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
    for (;;) {
        iovec data{bytes.data(), bytes.size()};
        ControlRoom control{};
        msghdr header{};
        header.msg_iov = &data;
        header.msg_iovlen = 1;
        header.msg_control = &control;
        header.msg_controllen = sizeof(control);
        const ssize_t size = ::recvmsg(socket_.get(), &header, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
        if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
            const Result<bool> something = ready(socket_.get(), POLLIN, deadline);
            if (!something) {
                return something.error();
            }
            if (!something.value()) {
                return late("nothing came", timeout_ns);
            }
            continue;
        }
        if (size < 0 && errno == ECONNRESET) {
            continue;  // a message of ours lay unread over there; told once, and what it had sent before comes after
        }
        if (size < 0) {
            return systemError("recvmsg");
        }
        std::vector<UniqueFd> fds = takeDescriptors(header);
        if (size == 0 && hungUp(socket_.get())) {
            return closed();
        }
        if (size == 0) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, kThing, "a message of 0 bytes came",
                         "the other process is broken"};
        }
        if ((static_cast<unsigned>(header.msg_flags) & unsigned{MSG_TRUNC | MSG_CTRUNC}) != 0) {
            return Error{
                SLUICE_ERROR_INVALID_ARGUMENT, kThing,
                fmt::format("a message was cut: expected at most {} bytes and {} descriptors", kMaxMessage, kFdRoom),
                "the other process is broken, or this one is out of descriptors"};
        }
        return Packet{{bytes.begin(), bytes.begin() + size}, std::move(fds)};
    }
}

bool Channel::closedThere(std::uint64_t timeout_ns) const {
    const Result<bool> hung_up = ready(socket_.get(), 0, deadlineAfter(timeout_ns));
    return !hung_up || hung_up.value();
}

void Channel::shutdown() const {
    (void)::shutdown(socket_.get(), SHUT_RDWR);
}

}  // namespace sluice::isolate
