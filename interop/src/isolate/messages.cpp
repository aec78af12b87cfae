// SPDX-License-Identifier: MIT
#include "sluice/isolate/messages.hpp"

#include <cstring>
#include <utility>

#include "isolate/bytes.hpp"

namespace sluice::isolate {

namespace {

constexpr std::uint32_t kMagic = 0x53'4C'49'53;  // "SLIS"
constexpr std::uint16_t kVersion = 1;

struct Header {
    std::uint32_t magic = kMagic;
    std::uint16_t version = kVersion;
    std::uint16_t kind = 0;
    std::uint32_t length = 0;  ///< of what follows the header
    std::uint32_t fds = 0;
    std::uint64_t call = 0;
};
static_assert(sizeof(Header) == 24 && std::is_trivially_copyable_v<Header>);

constexpr const char* kRemedy = "the two processes are not of one release, or the other one is broken";

Error broken(std::string_view kind, std::size_t at, const std::string& expected, const std::string& found) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, "message " + std::string(kind),
            "at byte " + std::to_string(at) + ": expected " + expected + ", found " + found, kRemedy};
}

template <typename T>
Result<Message> decodeAs(std::span<const std::byte> bytes, const Header& header) {
    if (header.fds < T::kFdsMin || header.fds > T::kFdsMax) {
        return broken(T::kName, offsetof(Header, fds),
                      T::kFdsMin == T::kFdsMax
                          ? std::to_string(T::kFdsMin) + " descriptors"
                          : std::to_string(T::kFdsMin) + " to " + std::to_string(T::kFdsMax) + " descriptors",
                      std::to_string(header.fds));
    }
    T message;
    Reader reader(bytes, T::kName, sizeof(Header));
    T::fields(reader, message);
    if (Status status = reader.finish(); !status) {
        return status.error();
    }
    return Message(std::move(message));
}

using Decoder = Result<Message> (*)(std::span<const std::byte>, const Header&);

template <std::size_t... Index>
constexpr auto makeDecoders(std::index_sequence<Index...> /*places*/) {
    return std::array<Decoder, sizeof...(Index)>{&decodeAs<std::variant_alternative_t<Index, Message>>...};
}
constexpr auto kDecoders = makeDecoders(std::make_index_sequence<std::variant_size_v<Message>>{});

}  // namespace

std::string_view nameOf(const Message& message) {
    return std::visit([](const auto& held) { return std::decay_t<decltype(held)>::kName; }, message);
}

std::vector<std::byte> encode(const Message& message, std::uint64_t call, std::uint32_t fds) {
    Writer writer;
    writer.bytes().resize(sizeof(Header));
    std::visit([&](const auto& held) { std::decay_t<decltype(held)>::fields(writer, held); }, message);
    Header header;
    header.kind = static_cast<std::uint16_t>(message.index());
    header.length = static_cast<std::uint32_t>(writer.bytes().size() - sizeof(Header));
    header.fds = fds;
    header.call = call;
    std::memcpy(writer.bytes().data(), &header, sizeof(header));
    return std::move(writer.bytes());
}

Result<Decoded> decode(std::span<const std::byte> bytes, std::uint32_t fds) {
    if (bytes.size() < sizeof(Header) || bytes.size() > kMaxMessage) {
        return broken("header", 0,
                      std::to_string(sizeof(Header)) + " to " + std::to_string(kMaxMessage) + " bytes in all",
                      std::to_string(bytes.size()));
    }
    Header header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.magic != kMagic || header.version != kVersion) {
        return broken("header", 0, "magic " + std::to_string(kMagic) + " and version " + std::to_string(kVersion),
                      std::to_string(header.magic) + " and " + std::to_string(header.version));
    }
    if (header.kind >= kDecoders.size()) {
        return broken("header", offsetof(Header, kind), "a kind below " + std::to_string(kDecoders.size()),
                      std::to_string(header.kind));
    }
    if (header.length != bytes.size() - sizeof(Header)) {
        return broken("header", offsetof(Header, length),
                      "a length of " + std::to_string(bytes.size() - sizeof(Header)), std::to_string(header.length));
    }
    if (header.fds != fds) {
        return broken("header", offsetof(Header, fds), std::to_string(fds) + " descriptors, as came with it",
                      std::to_string(header.fds));
    }
    Result<Message> message = kDecoders.at(header.kind)(bytes, header);
    if (!message) {
        return message.error();
    }
    return Decoded{header.call, std::move(message).value()};
}

}  // namespace sluice::isolate
