// Why bytes are no payload, or a value has none.
#pragma once

#include <string_view>

namespace talus::protocol {

enum class CodecError { kMalformed, kTooLarge, kEmpty, kInternal };
std::string_view describe(CodecError error);

}  // namespace talus::protocol
