// The one thing needed to write JSON by hand: a string that cannot break out of its quotes. Pure.
#pragma once

#include <string>
#include <string_view>

namespace talus::server {

/// Appends `text` in quotes, escaped; bytes that are not UTF-8 become U+FFFD.
void append_json_string(std::string& out, std::string_view text);
std::string json_string(std::string_view text);

}  // namespace talus::server
