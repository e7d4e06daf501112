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

void set_socket_options(int descriptor) {
  set_option(descriptor, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(descriptor, SOL_SOCKET, SO_SNDBUF, kSocketSendBytes);
  set_option(descriptor, IPPROTO_TCP, TCP_NOTSENT_LOWAT, kSocketUnsentBytes);
}

}  // namespace talus::server
