#include "protocol/message.hpp"

#include <array>

namespace talus::protocol {

std::string_view name_of(const Message& message) {
  // In the order of the variant.
  static constexpr std::array<std::string_view, std::variant_size_v<Message>> kNames{
      "hello", "welcome", "refused", "view", "view_accepted", "held", "want",  "chunk",
      "leave", "idle",    "credit",  "ping", "pong",          "bye",  "strip", "failed"};
  return kNames[message.index()];
}

std::string_view name_of(ByeReason reason) {
  switch (reason) {
    case ByeReason::kLeaving:
      return "leaving";
    case ByeReason::kDraining:
      return "draining";
    case ByeReason::kMalformed:
      return "malformed";
    case ByeReason::kTooManyMessages:
      return "too_many_messages";
    case ByeReason::kTooSlow:
      return "too_slow";
    case ByeReason::kSilent:
      return "silent";
    case ByeReason::kInternal:
      return "internal";
  }
  return "unknown";
}

std::string_view name_of(RefusedReason reason) {
  switch (reason) {
    case RefusedReason::kVersion:
      return "version";
    case RefusedReason::kWorld:
      return "world";
    case RefusedReason::kToken:
      return "token";
    case RefusedReason::kFormat:
      return "format";
    case RefusedReason::kBusy:
      return "busy";
    case RefusedReason::kMalformed:
      return "malformed";
  }
  return "unknown";
}

std::string_view describe(MessageError error) {
  switch (error) {
    case MessageError::kTooShort:
      return "the message ends before its head does";
    case MessageError::kTooLarge:
      return "the message, or a text or list inside it, is longer than its limit";
    case MessageError::kMalformed:
      return "the head is not a valid FlatBuffers Envelope, or the payload is not as long as it says";
    case MessageError::kUnknown:
      return "the message is of a type that this version does not know";
    case MessageError::kBadKey:
      return "a chunk key is outside the world";
  }
  return "unknown";
}

}  // namespace talus::protocol
