#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "core/sensor_network/sensor_pair.hpp"
#include "dashboard/access.hpp"
#include "dashboard/dashboard_node.hpp"
#include "dashboard/page_files.hpp"
#include "dashboard/server.hpp"
#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"
#include "rig/session.hpp"

namespace voqcal {
namespace {

namespace ip = boost::asio::ip;

/// Where others reach this host, for a server that listens at every address: what the kernel would
/// send from. Nothing is sent.
ip::address OutwardAddress(const ip::address& any) {
  boost::asio::io_context context;
  ip::udp::socket socket(context);
  boost::system::error_code error;
  const char* const example = any.is_v6() ? "2001:db8::1" : "192.0.2.1";  // RFC 3849, RFC 5737
  socket.connect({ip::make_address(example), 9}, error);
  return error ? ip::make_address(any.is_v6() ? "::1" : "127.0.0.1")
               : socket.local_endpoint().address();
}

/// Where this host can be reached, for a server that listens at `address`: the likeliest first, and
/// its own address for itself only if there is no other (a network without a way out has one).
std::vector<ip::address> ReachableAt(const ip::address& address) {
  if (!address.is_unspecified()) return {address};
  const ip::address outward = OutwardAddress(address);
  std::vector<ip::address> all;
  if (!outward.is_loopback()) all.push_back(outward);
  ifaddrs* found = nullptr;
  if (getifaddrs(&found) != 0) return {outward};
  for (const ifaddrs* each = found; each != nullptr; each = each->ifa_next) {
    const bool is_up = (each->ifa_flags & IFF_UP) != 0 && (each->ifa_flags & IFF_LOOPBACK) == 0;
    if (!is_up || each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in own{};
    std::memcpy(&own, each->ifa_addr, sizeof(own));
    const ip::address_v4 next(ntohl(own.sin_addr.s_addr));
    if (std::find(all.begin(), all.end(), ip::address(next)) == all.end()) all.emplace_back(next);
  }
  freeifaddrs(found);
  if (all.empty()) all.push_back(outward);
  return all;
}

std::vector<std::string> ReportCommand(const std::filesystem::path& session,
                                       const std::filesystem::path& rig_path) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "report";
  return {program, session, "--rig", rig_path};
}

/// A line each.
std::string PageAddresses(const DashboardOptions& options,
                          const DashboardServer& server,
                          const std::string& token) {
  std::string lines;
  for (const ip::address& address : ReachableAt(ip::make_address(options.address))) {
    const std::string host =
        address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
    lines += (lines.empty() ? "" : "\n") + std::string("http://") + host + ":" +
             std::to_string(server.port()) + "/" + token + "/";
  }
  return lines;
}

/// The address lets its reader command the rig: it is shown to who sits at the terminal, and else
/// lies in a file that its owner alone may read.
void TellAddresses(const std::string& lines, const std::filesystem::path& file) {
  SaveAddresses(file, lines);
  spdlog::info("the page: {}", isatty(STDERR_FILENO) != 0 ? lines : "see " + file.string());
}

/// A pair alone has the session to itself; of several each has a folder in it. Their reports are by
/// the rig that the session is of. (With tools/up that is a copy: what is changed in the rig file
/// since counts for the next session.)
std::vector<ShownPair> ShownPairs(const std::vector<Rig>& pairs,
                                  const std::filesystem::path& session,
                                  const std::filesystem::path& rig_path) {
  const std::filesystem::path own = session / "rig.yaml";
  const bool has_own = std::filesystem::exists(own);
  if (pairs.size() == 1) {
    return {{pairs.front(), session, ReportCommand(session, has_own ? own : rig_path)}};
  }
  std::vector<ShownPair> shown;
  for (const Rig& rig : pairs) {
    const std::filesystem::path folder = session / PairName(rig.lidar_name, rig.camera_name);
    const std::string pair_of_own = own.string() + "#" + rig.lidar_name + "," + rig.camera_name;
    shown.push_back(
        {rig, folder, ReportCommand(folder, has_own ? pair_of_own : rig.path.string())});
  }
  return shown;
}

void Run(const ProcessArgs& args) {
  const std::vector<Rig> pairs = LoadPairs(args.rig_path);
  const Rig& rig = pairs.front();
  const std::filesystem::path session =
      pairs.size() == 1 ? SessionFolder(args.session_dir, rig)
                        : args.session_dir.value_or(std::filesystem::path("logs") / rig.rig_name);
  std::filesystem::create_directories(session);
  const std::filesystem::path address_file = session / "dashboard_url.txt";

  ServerOptions options;
  options.address = rig.dashboard.address;
  options.port = static_cast<std::uint16_t>(rig.dashboard.port);
  options.host_name = rig.dashboard.host_name;
  options.token = TokenOfSession(address_file);
  options.files = PageFiles();
  options.pairs.clear();
  for (const Rig& each : pairs) {
    options.pairs.push_back(PairName(each.lidar_name, each.camera_name));
  }

  const std::vector<ShownPair> shown = ShownPairs(pairs, session, args.rig_path);
  for (const ShownPair& pair : shown) std::filesystem::create_directories(pair.session_folder);

  // The page can be opened before the module hears anything: tools/up waits for the latter only.
  DashboardServer server(options);
  TellAddresses(PageAddresses(rig.dashboard, server, options.token), address_file);
  Bus bus(args.lcm_url.value_or(rig.lcm_url));
  DashboardNode node(shown, PlanOfRig(args.rig_path, pairs), &bus, &server, session);
  if (!ip::make_address(options.address).is_loopback()) {
    spdlog::warn("the page can be reached over the network, without encryption: {}",
                 options.address);
  }
  Spin(bus, node, rig.channels.module_status, args);
  spdlog::info(node.Summary());
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "dashboard", "Serves a web page that shows the session and takes commands: CALIB_COMMAND."};
  return voqcal::RunProcess(argc, argv, info, voqcal::Run);
}
