#include "protocol/codec_error.hpp"

namespace talus::protocol {

std::string_view describe(CodecError error) {
  switch (error) {
    case CodecError::kMalformed:
      return "the payload is not a chunk of this lattice";
    case CodecError::kTooLarge:
      return "the payload is longer than a message may be";
    case CodecError::kEmpty:
      return "a mesh without triangles has no payload";
    case CodecError::kInternal:
      return "the codec failed on a mesh of our own";
  }
  return "unknown";
}

}  // namespace talus::protocol
