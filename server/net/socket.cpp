#include "server/net/socket.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "server/net/limits.hpp"

namespace talus::server {

namespace {

void set_option(int descriptor, int level, int name, int value) {
  ::setsockopt(descriptor, level, name, &value, sizeof(value));
}

}  // namespace

void set_socket_options(Socket& socket) {
  const int descriptor = socket.native_handle();
  set_option(descriptor, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(descriptor, SOL_SOCKET, SO_SNDBUF, kSocketSendBytes);
  set_option(descriptor, IPPROTO_TCP, TCP_NOTSENT_LOWAT, kSocketUnsentBytes);
  asio::error_code error;
  socket.non_blocking(true, error);
}

}  // namespace talus::server
