// What can go wrong between a client and a server. Pure data.
#pragma once

#include <string>
#include <string_view>

namespace talus::client {

enum class ErrorCode {
  kUrl,        ///< the server's URL cannot be used
  kResolve,    ///< no address for the host
  kConnect,    ///< nobody listens there, or the connection broke
  kTimeout,    ///< no answer in time
  kHttp,       ///< an answer that is not HTTP, or too large
  kHandshake,  ///< the server did not become a WebSocket
  kProtocol,   ///< bytes that break the protocol
  kRefused,    ///< the server refused the hello
  kBye,        ///< the server said goodbye
};
std::string_view name_of(ErrorCode code);

struct ClientError {
  ErrorCode code{};
  std::string message;   ///< a sentence for people
  bool may_pass = true;  ///< trying again later may help
};

}  // namespace talus::client
