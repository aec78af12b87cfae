// SPDX-License-Identifier: MIT
#include "sluice/fd.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <vector>

namespace {

using sluice::UniqueFd;

std::size_t openDescriptors() {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        ++count;
    }
    return count;
}

bool isOpen(int fd) {
    return fcntl(fd, F_GETFD) != -1;
}

UniqueFd openNull() {
    return UniqueFd(open("/dev/null", O_RDWR | O_CLOEXEC));
}

TEST(UniqueFd, IsEmptyByDefault) {
    const UniqueFd fd;
    EXPECT_FALSE(fd.valid());
    EXPECT_EQ(fd.get(), -1);
    EXPECT_FALSE(fd.duplicate().valid());
}

TEST(UniqueFd, ClosesAtTheEndOfItsScope) {
    const std::size_t before = openDescriptors();
    int number = -1;
    {
        const UniqueFd fd = openNull();
        ASSERT_TRUE(fd.valid());
        number = fd.get();
        EXPECT_EQ(openDescriptors(), before + 1);
    }
    EXPECT_FALSE(isOpen(number));
    EXPECT_EQ(openDescriptors(), before);
}

TEST(UniqueFd, MoveConstructionLeavesTheSourceEmpty) {
    UniqueFd first = openNull();
    const int number = first.get();
    const UniqueFd second = std::move(first);
    EXPECT_FALSE(
        first.valid());  // NOLINT(bugprone-use-after-move,clang-analyzer-cplusplus.Move): the promise under test
    EXPECT_EQ(second.get(), number);
    EXPECT_TRUE(isOpen(number));
}

TEST(UniqueFd, MoveAssignmentClosesWhatWasHeld) {
    UniqueFd first = openNull();
    UniqueFd second = openNull();
    const int kept = first.get();
    const int closed = second.get();
    second = std::move(first);
    EXPECT_EQ(second.get(), kept);
    EXPECT_TRUE(isOpen(kept));
    EXPECT_FALSE(isOpen(closed));
}

TEST(UniqueFd, SelfMoveKeepsTheDescriptor) {
    UniqueFd fd = openNull();
    const int number = fd.get();
    UniqueFd& alias = fd;
    fd = std::move(alias);
    EXPECT_EQ(fd.get(), number);
    EXPECT_TRUE(isOpen(number));
}

TEST(UniqueFd, ReleaseGivesUpWithoutClosing) {
    UniqueFd fd = openNull();
    const int number = fd.release();
    EXPECT_FALSE(fd.valid());
    EXPECT_EQ(fd.release(), -1);
    EXPECT_TRUE(isOpen(number));
    EXPECT_EQ(close(number), 0);
}

TEST(UniqueFd, ResetTakesAnotherDescriptor) {
    UniqueFd fd = openNull();
    const int old = fd.get();
    UniqueFd other = openNull();
    const int next = other.release();
    fd.reset(next);
    EXPECT_FALSE(isOpen(old));
    EXPECT_EQ(fd.get(), next);
    fd.reset();
    EXPECT_FALSE(isOpen(next));
    EXPECT_FALSE(fd.valid());
}

TEST(UniqueFd, DuplicateIsTheSameFileAndCloseOnExec) {
    std::array<int, 2> ends{-1, -1};
    ASSERT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
    const UniqueFd read_end(ends[0]);
    UniqueFd write_end(ends[1]);
    const UniqueFd copy = write_end.duplicate();
    ASSERT_TRUE(copy.valid());
    EXPECT_NE(copy.get(), write_end.get());
    EXPECT_EQ(fcntl(copy.get(), F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
    write_end.reset();
    ASSERT_EQ(write(copy.get(), "x", 1), 1);
    char found = 0;
    ASSERT_EQ(read(read_end.get(), &found, 1), 1);
    EXPECT_EQ(found, 'x');
}

TEST(UniqueFd, DuplicateIsEmptyWhenTheProcessIsOutOfDescriptors) {
    const UniqueFd fd = openNull();
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    rlimit none = before;
    none.rlim_cur = 0;  // no new descriptor may be opened; those already open stay
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
    const UniqueFd copy = fd.duplicate();
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    EXPECT_FALSE(copy.valid());
    EXPECT_TRUE(isOpen(fd.get()));
}

TEST(UniqueFd, AThousandMovesAndCopiesLeaveNoDescriptorBehind) {
    const std::size_t before = openDescriptors();
    {
        std::vector<UniqueFd> held;
        for (int i = 0; i < 1000; ++i) {
            UniqueFd fd = openNull();
            UniqueFd copy = fd.duplicate();
            ASSERT_TRUE(copy.valid());
            if (i % 10 == 0) {
                held.push_back(std::move(copy));  // reallocation of the vector moves them about
            }
        }
        EXPECT_EQ(openDescriptors(), before + 100);
    }
    EXPECT_EQ(openDescriptors(), before);
}

}  // namespace
