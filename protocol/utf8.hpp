// Whether bytes from outside are text. Pure.
#pragma once

#include <string_view>

namespace talus::protocol {

/// Well-formed UTF-8 after RFC 3629: no overlong form, no surrogate, nothing past U+10FFFF.
bool is_utf8(std::string_view bytes);

}  // namespace talus::protocol
