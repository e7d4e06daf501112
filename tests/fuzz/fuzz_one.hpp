// What a fuzz target is: any bytes in, no crash, and what was let in holds its promises.
#pragma once

#include <cstddef>
#include <cstdint>

int fuzz_one(const std::uint8_t* data, std::size_t size);
