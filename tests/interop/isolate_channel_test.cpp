// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <vector>

#include "sluice/isolate/channel.hpp"
#include "sluice/isolate/sealed_memory.hpp"

namespace sluice::isolate {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kSoonNs = 20'000'000;
constexpr std::uint64_t kLongNs = 20'000'000'000;

long openDescriptors() {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return std::distance(begin(all), end(all));
}

class IsolateChannel : public ::testing::Test {
  protected:
    void SetUp() override {
        auto ends = Channel::pair();
        ASSERT_TRUE(ends) << ends.error().message();
        here_ = std::move(ends.value().first);
        there_ = std::move(ends.value().second);
    }
    /// Bytes and descriptors that no Channel would send.
    void sendRaw(const void* bytes, std::size_t size, const std::vector<int>& fds) const {
        iovec data{const_cast<void*>(bytes), size};
        alignas(cmsghdr) std::array<char, CMSG_SPACE(64 * sizeof(int))> control{};
        msghdr header{};
        header.msg_iov = &data;
        header.msg_iovlen = 1;
        if (!fds.empty()) {
            header.msg_control = control.data();
            header.msg_controllen = CMSG_SPACE(fds.size() * sizeof(int));
            cmsghdr* part = CMSG_FIRSTHDR(&header);
            part->cmsg_level = SOL_SOCKET;
            part->cmsg_type = SCM_RIGHTS;
            part->cmsg_len = CMSG_LEN(fds.size() * sizeof(int));
            std::memcpy(CMSG_DATA(part), fds.data(), fds.size() * sizeof(int));
        }
        ASSERT_EQ(::sendmsg(there_.fd(), &header, 0), static_cast<ssize_t>(size)) << std::strerror(errno);
    }

    Channel here_, there_;
};

TEST_F(IsolateChannel, AMessageWithoutAByteIsNoMessageAndNoEnd) {
    sendRaw("", 0, {});
    ASSERT_TRUE(there_.send(Info{}, 3, {}, kLongNs));
    EXPECT_EQ(here_.receive(kLongNs).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    const Result<Received> next = here_.receive(kLongNs);
    ASSERT_TRUE(next) << next.error().message();
    EXPECT_EQ(next.value().call, 3U);
    there_ = Channel();
    EXPECT_EQ(here_.receive(kLongNs).error().code, SLUICE_ERROR_DEVICE_LOST);
}

TEST_F(IsolateChannel, ADescriptorArrivesOnceAndTheSendersStaysItsOwn) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
    const UniqueFd read_end(ends[0]);
    const UniqueFd write_end(ends[1]);
    const long before = openDescriptors();
    const int fd = write_end.get();
    ASSERT_TRUE(there_.send(ShareImage{}, 5, std::span(&fd, 1), kLongNs));
    {
        Result<Received> received = here_.receive(kLongNs);
        ASSERT_TRUE(received) << received.error().message();
        EXPECT_EQ(received.value().call, 5U);
        ASSERT_EQ(received.value().fds.size(), 1U);
        EXPECT_NE(received.value().fds[0].get(), fd);
        EXPECT_EQ(::fcntl(received.value().fds[0].get(), F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
        EXPECT_EQ(openDescriptors(), before + 1);
        ASSERT_EQ(::write(received.value().fds[0].get(), "x", 1), 1);
    }
    EXPECT_EQ(openDescriptors(), before);
    char found = 0;
    ASSERT_EQ(::read(read_end.get(), &found, 1), 1);
    EXPECT_EQ(found, 'x');
}

TEST_F(IsolateChannel, DescriptorsOfAMessageThatIsNoneAreClosed) {
    const UniqueFd null(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    const long before = openDescriptors();
    const std::vector<std::byte> honest = encode(Info{}, 1, 0);
    const std::vector<std::byte> two = encode(ShareImage{}, 1, 2);
    const struct {
        const std::vector<std::byte>& bytes;
        std::size_t fds;
        const char* complaint;
    } cases[] = {{honest, 1, "expected 1 descriptors, as came with it, found 0"},
                 {two, 2, "message share_image"},
                 {two, 40, "a message was cut"}};
    for (const auto& [bytes, fds, complaint] : cases) {
        ASSERT_NO_FATAL_FAILURE(sendRaw(bytes.data(), bytes.size(), std::vector<int>(fds, null.get())));
        const Result<Received> received = here_.receive(kLongNs);
        ASSERT_FALSE(received);
        EXPECT_EQ(received.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(received.error().message(), HasSubstr(complaint));
        EXPECT_EQ(openDescriptors(), before) << complaint;
    }
}

TEST_F(IsolateChannel, AMessageThatIsTooLongIsAnErrorAndTheNextOneIsRead) {
    const std::vector<char> large(kMaxMessage + 1);
    ASSERT_NO_FATAL_FAILURE(sendRaw(large.data(), large.size(), {}));
    ASSERT_TRUE(there_.send(Poll{{}, 3}, 9, {}, kLongNs));
    EXPECT_THAT(here_.receive(kLongNs).error().message(), HasSubstr("a message was cut: expected at most 16384 bytes"));
    EXPECT_EQ(here_.receive(kLongNs).value().call, 9U);
}

TEST_F(IsolateChannel, SilenceIsATimeoutAndAnEndIsHeardAfterWhatWasSent) {
    EXPECT_EQ(here_.receive(kSoonNs).error().code, SLUICE_TIMEOUT);
    EXPECT_EQ(here_.receive(0).error().code, SLUICE_TIMEOUT);
    ASSERT_TRUE(there_.send(Info{}, 1, {}, kLongNs));
    ASSERT_TRUE(there_.send(Info{}, 2, {}, kLongNs));
    there_ = Channel();
    EXPECT_EQ(here_.receive(kLongNs).value().call, 1U);
    EXPECT_EQ(here_.receive(kLongNs).value().call, 2U);
    EXPECT_EQ(here_.receive(kLongNs).error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_EQ(here_.send(Info{}, 3, {}, kLongNs).error().code, SLUICE_ERROR_DEVICE_LOST);
}

TEST_F(IsolateChannel, AReceiverThatSleepsDoesNotHoldTheSenderForEver) {
    Status status;
    for (int i = 0; i < 100'000 && status; ++i) {
        status = here_.send(Log{{}, 1, std::string(2000, 'x')}, 0, {}, kSoonNs);
    }
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, SLUICE_TIMEOUT);
    EXPECT_TRUE(there_.receive(kLongNs));
}

TEST(SealedMemory, HoldsWhatWasCopiedAndCannotChange) {
    const std::array<float, 3> a{1, 2, 3};
    const std::array<float, 2> b{4, 5};
    const Result<UniqueFd> made = sealedCopy({std::as_bytes(std::span(a)), std::as_bytes(std::span(b))});
    ASSERT_TRUE(made) << made.error().message();
    const Result<Mapping> mapped = mapSealed(made.value(), 20);
    ASSERT_TRUE(mapped) << mapped.error().message();
    EXPECT_EQ(static_cast<const float*>(mapped.value().at())[4], 5.0F);
    EXPECT_NE(::ftruncate(made.value().get(), 4), 0);
    EXPECT_NE(::write(made.value().get(), "x", 1), 1);
    EXPECT_THAT(mapSealed(made.value(), 24).error().message(), HasSubstr("expected 24 bytes, found 20"));
}

TEST(SealedMemory, MemoryThatItsOwnerCouldCutIsRefused) {
    const UniqueFd loose(::memfd_create("loose", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    ASSERT_EQ(::ftruncate(loose.get(), 4096), 0);
    EXPECT_THAT(mapSealed(loose, 4096).error().message(), HasSubstr("its size or contents could still change"));
    EXPECT_FALSE(mapShared(loose, 4096));
    const UniqueFd file(::open("/proc/self/exe", O_RDONLY | O_CLOEXEC));
    EXPECT_FALSE(mapSealed(file, std::filesystem::file_size("/proc/self/exe")));
    EXPECT_FALSE(mapSealed(UniqueFd(), 16));
}

}  // namespace
}  // namespace sluice::isolate
