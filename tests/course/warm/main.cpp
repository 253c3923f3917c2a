// Starts a program in Python without starting Python: asks the server of warm_start.py for a fork that speaks
// on this process's standard streams, and ends when it does.
//
// usage: plumb_warm_start SOCKET PROGRAM
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <string_view>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (std::strlen(argv[1]) >= sizeof address.sun_path) return 2;
  std::strcpy(address.sun_path, argv[1]);
  const int server = socket(AF_UNIX, SOCK_STREAM, 0);
  if (server < 0 || connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return 3;

  const std::string_view program = argv[2];
  iovec text{const_cast<char*>(program.data()), program.size()};
  constexpr int kStreams[] = {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO};
  alignas(cmsghdr) char room[CMSG_SPACE(sizeof kStreams)] = {};
  msghdr message{};
  message.msg_iov = &text;
  message.msg_iovlen = 1;
  message.msg_control = room;
  message.msg_controllen = sizeof room;
  cmsghdr* streams = CMSG_FIRSTHDR(&message);
  streams->cmsg_level = SOL_SOCKET;
  streams->cmsg_type = SCM_RIGHTS;
  streams->cmsg_len = CMSG_LEN(sizeof kStreams);
  std::memcpy(CMSG_DATA(streams), kStreams, sizeof kStreams);
  if (sendmsg(server, &message, 0) < 0) return 3;
  for (const int stream : kStreams) close(stream);  // the fork has them: its end is theirs
  char code = 0;
  return read(server, &code, 1) == 1 ? code : 1;
}
