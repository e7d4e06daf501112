#include "server/net/socket.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/syscall.h>

#include "server/net/limits.hpp"

namespace talus::server {

namespace {

void set_option(int descriptor, int level, int name, int value) {
  ::setsockopt(descriptor, level, name, &value, sizeof(value));
}

}  // namespace

ssize_t receive_some(int descriptor, std::span<std::byte> into) {
  return ::syscall(SYS_recvfrom, descriptor, into.data(), into.size(), 0, nullptr, nullptr);
}

ssize_t send_some(int descriptor, const msghdr& message) {
  return ::syscall(SYS_sendmsg, descriptor, &message, MSG_NOSIGNAL);
}

void set_socket_options(int descriptor) {
  set_option(descriptor, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(descriptor, SOL_SOCKET, SO_SNDBUF, kSocketSendBytes);
  set_option(descriptor, IPPROTO_TCP, TCP_NOTSENT_LOWAT, kSocketUnsentBytes);
}

}  // namespace talus::server
