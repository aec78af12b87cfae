// SPDX-License-Identifier: MIT
// In place of sluice-renderer: a process that keeps to the form of the messages and to nothing else. The plugin that it
// is given is no file; its name says what it does.
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string_view>
#include <thread>

#include "sluice/isolate/channel.hpp"
#include "sluice/isolate/server.hpp"

namespace {

using namespace sluice::isolate;

[[noreturn]] void sleepOn() {
    for (;;) {
        ::pause();
    }
}

/// Bit n: descriptor n is open.
std::uint64_t openStreams() {
    std::uint64_t open = 0;
    for (int fd = 0; fd < 3; ++fd) {
        open |= ::fcntl(fd, F_GETFD) >= 0 ? 1U << static_cast<unsigned>(fd) : 0U;
    }
    return open;
}

bool send(const Channel& channel, const Message& message, std::uint64_t call) {
    return channel.send(message, call, {}, kForever).ok();
}

/// What it does in place of an answer to `call`.
void answer(const Channel& channel, std::string_view what, std::uint64_t call) {
    Returned returned;
    returned.value = openStreams();
    if (what == "lines") {
        while (send(channel, Line{{}, "another"}, 0)) {
        }
    } else if (what == "slow-lines") {
        while (send(channel, Line{{}, "another"}, 0)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    } else if (what == "asks") {
        while (send(channel, RetireImage{}, call) && channel.receive(kForever)) {
        }
    } else if (what == "answers") {
        while (send(channel, returned, call)) {
        }
    } else if (what == "twice") {
        (void)(send(channel, returned, call) && send(channel, returned, call));
    } else if (what == "empty") {
        (void)::send(kChannelFd, "", 0, MSG_NOSIGNAL);
        sleepOn();
    } else if (what == "half-closed") {
        (void)::shutdown(kChannelFd, SHUT_WR);
        sleepOn();
    } else if (what == "talks") {
        (void)send(channel, Log{{}, SLUICE_LOG_INFO, "a word"}, 0);
        sleepOn();
    } else {
        (void)send(channel, returned, call);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4 || !endWithHost(argv[2])) {
        return 1;
    }
    const std::string_view path = argv[3];
    const std::string_view what = path.substr(path.rfind('/') + 1);
    const Channel channel{sluice::UniqueFd(kChannelFd)};
    if (!channel.receive(kForever)) {
        return 1;
    }
    if (what == "deaf") {
        (void)::shutdown(kChannelFd, SHUT_RD);
    }
    (void)send(channel, Welcome{{}, SLUICE_ABI_VERSION, "rogue", ""}, 0);
    if (what == "deaf") {
        sleepOn();
    }
    while (const auto received = channel.receive(kForever)) {
        answer(channel, what, received.value().call);
    }
    return 0;
}
