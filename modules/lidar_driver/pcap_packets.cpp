#include "lidar_driver/pcap_packets.hpp"

#include <array>
#include <stdexcept>
#include <string>

#include <pcap/pcap.h>
#include <spdlog/spdlog.h>

#include "files/foreign_file.hpp"
#include "lidar_driver/ip_fragments.hpp"
#include "lidar_driver/udp_frame.hpp"

namespace voqcal {
namespace {

struct PcapCloser {
  void operator()(pcap_t* pcap) const { pcap_close(pcap); }
};

std::optional<FrameLink> LinkOf(int datalink) {
  switch (datalink) {
    case DLT_EN10MB:
      return FrameLink::kEthernet;
    case DLT_LINUX_SLL:
      return FrameLink::kCooked;
    case DLT_LINUX_SLL2:
      return FrameLink::kCooked2;
    case DLT_NULL:
    case DLT_LOOP:
      return FrameLink::kLoopback;
    case DLT_RAW:
    case DLT_IPV4:
      return FrameLink::kIp;
    default:
      return std::nullopt;
  }
}

class PcapPackets : public PacketSource {
 public:
  PcapPackets(const std::filesystem::path& path, int port) : path_(path), port_(port) {
    std::array<char, PCAP_ERRBUF_SIZE> error{};
    pcap_.reset(pcap_open_offline(path.c_str(), error.data()));
    if (!pcap_) {
      const std::string foreign = ForeignFileText(path);
      const std::string name = path.string() + ": ";
      std::string problem = error.data();
      if (problem.rfind(name, 0) == 0) problem.erase(0, name.size());
      throw std::runtime_error(name + (foreign.empty() ? problem : foreign));
    }
    const auto link = LinkOf(pcap_datalink(pcap_.get()));
    if (!link) {
      throw std::runtime_error(path.string() + ": frames of link type " +
                               std::to_string(pcap_datalink(pcap_.get())) + " are not understood");
    }
    link_ = *link;
  }

  std::optional<HostPacket> Next() override {
    pcap_pkthdr* header = nullptr;
    const u_char* data = nullptr;
    const int status = has_ended_ ? PCAP_ERROR_BREAK : pcap_next_ex(pcap_.get(), &header, &data);
    has_ended_ = status != 1;
    if (status == PCAP_ERROR) NoteDamage();
    if (has_ended_) return std::nullopt;
    const PacketBytes frame{data, header->caplen};
    auto payload = FindUdpPayload(link_, frame);
    const auto ip = payload ? std::nullopt : FindIp(link_, frame);
    const auto joined = ip ? fragments_.Add(*ip) : std::nullopt;
    if (joined) payload = FindUdpPayload(FrameLink::kIp, {joined->data(), joined->size()});
    if (!payload) {
      ++counts_[ip && IpFragments::IsPiece(*ip) ? "pieces of datagrams" : "frames without UDP"];
      return std::nullopt;
    }
    if (port_ != 0 && payload->port != port_) {
      ++counts_["packets to other ports"];
      ++other_ports_[payload->port];
      return std::nullopt;
    }
    return HostPacket{std::int64_t{header->ts.tv_sec} * 1000000 + header->ts.tv_usec,
                      {payload->bytes.data, payload->bytes.data + payload->bytes.size}};
  }

  bool HasEnded() const override { return has_ended_; }
  std::string Name() const override { return path_.string(); }
  const std::map<std::string, std::int64_t>& Counts() const override { return counts_; }

  std::optional<OtherPort> BusiestOtherPort() const override {
    std::optional<OtherPort> busiest;
    for (const auto& [port, num_packets] : other_ports_) {
      if (!busiest || num_packets > busiest->num_packets) busiest = OtherPort{port, num_packets};
    }
    return busiest;
  }

 private:
  void NoteDamage() {
    ++counts_["damage that ends the capture"];
    spdlog::warn("{}: ends here: {}", path_.string(), pcap_geterr(pcap_.get()));
  }

  std::filesystem::path path_;
  int port_;
  std::unique_ptr<pcap_t, PcapCloser> pcap_;
  FrameLink link_ = FrameLink::kEthernet;
  IpFragments fragments_;
  bool has_ended_ = false;
  std::map<std::string, std::int64_t> counts_;
  std::map<int, std::int64_t> other_ports_;  // how many packets went there
};

}  // namespace

std::unique_ptr<PacketSource> MakePcapPackets(const std::filesystem::path& path, int port) {
  return std::make_unique<PcapPackets>(path, port);
}

}  // namespace voqcal
