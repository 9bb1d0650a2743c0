#include "lidar_driver/udp_packets.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "rig/listening_address.hpp"

namespace voqcal {
namespace {

using Clock = std::chrono::steady_clock;

// Closes what it holds.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return value_; }

 private:
  int value_;
};

void Set(int socket_fd, int option, int value) {
  setsockopt(socket_fd, SOL_SOCKET, option, &value, sizeof(value));
}

class UdpPackets : public PacketSource {
 public:
  UdpPackets(const std::string& address, int port)
      : name_(address + ":" + std::to_string(port)),
        doubt_(AddressDoubt(address)),
        socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    constexpr int kReceiveBuffer = 2097152;  // over a second of a VLP-16, if the kernel grants it
    Set(socket_.get(), SO_RCVBUF, kReceiveBuffer);
    Set(socket_.get(), SO_TIMESTAMP, 1);
    Set(socket_.get(), SO_RXQ_OVFL, 1);
    sockaddr_in local{};
    local.sin_family = AF_INET;
    local.sin_port = htons(static_cast<std::uint16_t>(port));
    const bool is_bound =
        inet_pton(AF_INET, address.c_str(), &local.sin_addr) == 1 &&
        bind(socket_.get(), reinterpret_cast<sockaddr*>(&local), sizeof(local)) == 0;
    if (!is_bound) {
      const bool has_own_words = errno == EADDRNOTAVAIL && !doubt_.empty();
      const std::string why = std::strerror(errno);
      throw std::runtime_error("cannot receive on UDP " + name_ + ": " + why +
                               (has_own_words ? ": " + doubt_ : ""));
    }
  }

  std::optional<HostPacket> Next() override {
    constexpr int kMaxWaitMs = 50;
    pollfd waiting{socket_.get(), POLLIN, 0};
    if (poll(&waiting, 1, kMaxWaitMs) <= 0) return std::nullopt;
    return Receive();
  }

  bool HasEnded() const override { return false; }
  std::string Name() const override { return name_; }
  const std::map<std::string, std::int64_t>& Counts() const override { return counts_; }

  std::string State() const override {
    const bool is_silent = Clock::now() - last_arrival_ > std::chrono::seconds(1);
    if (!is_silent) return "running";
    return "waiting for packets on " + name_ + (doubt_.empty() ? "" : ": " + doubt_);
  }

 private:
  std::optional<HostPacket> Receive() {
    alignas(cmsghdr) std::array<char, 256> control{};
    iovec buffer{bytes_.data(), bytes_.size()};
    msghdr message{};
    message.msg_iov = &buffer;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t num_bytes = recvmsg(socket_.get(), &message, MSG_DONTWAIT);
    if (num_bytes < 0) return std::nullopt;  // a signal, or a checksum that the kernel refused
    last_arrival_ = Clock::now();
    HostPacket packet{0, {bytes_.begin(), bytes_.begin() + num_bytes}};
    for (cmsghdr* note = CMSG_FIRSTHDR(&message); note; note = CMSG_NXTHDR(&message, note)) {
      ReadNote(*note, &packet);
    }
    return packet;
  }

  // What the kernel says of a datagram: when it came, and how many found the buffer full so far.
  void ReadNote(const cmsghdr& note, HostPacket* packet) {
    if (note.cmsg_level != SOL_SOCKET) return;
    if (note.cmsg_type == SCM_TIMESTAMP) {
      timeval time{};
      std::memcpy(&time, CMSG_DATA(&note), sizeof(time));
      packet->utime = std::int64_t{time.tv_sec} * 1000000 + time.tv_usec;
    } else if (note.cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t num_dropped = 0;
      std::memcpy(&num_dropped, CMSG_DATA(&note), sizeof(num_dropped));
      if (num_dropped > 0) counts_["packets dropped, buffer full"] = num_dropped;
    }
  }

  std::string name_;
  std::string doubt_;  ///< About its address.
  Descriptor socket_;
  std::array<std::uint8_t, 65536> bytes_{};
  Clock::time_point last_arrival_;
  std::map<std::string, std::int64_t> counts_;
};

}  // namespace

std::unique_ptr<PacketSource> MakeUdpPackets(const std::string& address, int port) {
  return std::make_unique<UdpPackets>(address, port);
}

}  // namespace voqcal
