#include "messaging/bus.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include <lcm/lcm.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/starts_with.hpp"
#include "rig/lcm_url.hpp"

namespace voqcal {
namespace {

// A hundred raw images are hundreds of megabytes: a deeper queue would not help a reader that is
// too slow.
constexpr int kNumEvery = 100;
constexpr int kNumState = 30;

/// LCM_MAX_CHANNEL_NAME_LENGTH, which lcm.h does not export.
constexpr std::size_t kMaxChannelLength = 63;

/// The value of recv_buf_size in a URL, 0 if it has none (the kernel's default then holds).
std::int64_t RecvBufSize(const std::string& url) {
  static const std::string kKey = "recv_buf_size=";
  const std::size_t at = url.find(kKey);
  if (at == std::string::npos) return 0;
  return std::strtoll(url.c_str() + at + kKey.size(), nullptr, 10);
}

/// What the kernel gives a socket that asks for `wanted_bytes`: net.core.rmem_max caps it silently,
/// and containers do not show that file. Linux doubles the value for its own bookkeeping
/// (socket(7)).
std::optional<std::int64_t> GrantedReceiveBuffer(std::int64_t wanted_bytes) {
  const int socket_fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_fd < 0) return std::nullopt;
  const int wanted =
      static_cast<int>(std::min<std::int64_t>(wanted_bytes, std::numeric_limits<int>::max() / 2));
  int doubled = 0;
  socklen_t size = sizeof(doubled);
  const bool is_known =
      setsockopt(socket_fd, SOL_SOCKET, SO_RCVBUF, &wanted, sizeof(wanted)) == 0 &&
      getsockopt(socket_fd, SOL_SOCKET, SO_RCVBUF, &doubled, &size) == 0;
  close(socket_fd);
  return is_known ? std::optional<std::int64_t>(doubled / 2) : std::nullopt;
}

std::string CreationProblem(const std::string& url) {
  std::string text = "LCM cannot be opened at '" + url + "'";
  if (StartsWith(url, "udpm://")) {
    text +=
        ": is there a multicast route? If not: ip link set lo up; ip link set lo multicast on; "
        "ip route add 224.0.0.0/4 dev lo";
  } else if (StartsWith(url, "tcpq://")) {
    text += ": is its broker running? It is lcm.lcm.TCPService of lcm.jar";
  } else if (StartsWith(url, "file://")) {
    text += ": is it a readable LCM log?";
  }
  return text;
}

/// LCM takes channels as regular expressions; ours are names.
std::string EscapedForRegex(const std::string& name) {
  std::string escaped;
  for (const char c : name) {
    if (std::strchr("\\^$.|?*+()[]{}", c) != nullptr) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// What one channel's first subscription remembers.
struct ChannelMemory {
  std::int64_t fingerprint = 0;
  std::optional<std::int64_t> last_sequence;
  bool has_warned = false;
};

}  // namespace

/// Lives as long as the bus: LCM holds its address.
struct Bus::Subscription {
  Impl* impl = nullptr;
  std::string channel;
  Queue queue = Queue::kEvery;
  bool keeps_counts = false;
  Decoder decoder;

  static void OnMessage(const lcm_recv_buf_t* buffer, const char* channel, void* user);
};

struct Bus::Impl {
  lcm_t* lcm = nullptr;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  std::map<std::string, ChannelCounts> counts;
  std::map<std::string, ChannelMemory> memories;
  std::string session;
  std::set<std::string> foreign_sessions;  ///< That were warned of.
  std::exception_ptr thrown;               ///< By a handler, while C frames were on the stack.
  std::int64_t num_published = 0;
  std::int64_t num_publish_failures = 0;

  void Deliver(const Subscription& subscription, const void* bytes, std::size_t num_bytes);
  bool IsForeign(const std::string& channel, const std::string& other_session);
  void CountMalformed(const std::string& channel, const std::string& problem);
  void CountLosses(const std::string& channel, std::int64_t sequence);
};

void Bus::Impl::Deliver(const Subscription& subscription,
                        const void* bytes,
                        std::size_t num_bytes) {
  const Delivery delivery = subscription.decoder(bytes, num_bytes);
  if (!delivery.problem.empty()) {
    if (subscription.keeps_counts) CountMalformed(subscription.channel, delivery.problem);
    return;
  }
  if (IsForeign(subscription.channel, delivery.session)) return;
  if (subscription.keeps_counts) {
    ++counts[subscription.channel].num_received;
    if (delivery.sequence && subscription.queue == Queue::kEvery) {
      CountLosses(subscription.channel, *delivery.sequence);
    }
  }
  delivery.handle();
}

bool Bus::Impl::IsForeign(const std::string& channel, const std::string& other_session) {
  if (MayBeOf(session, other_session)) return false;
  ++counts[channel].num_foreign;
  if (foreign_sessions.insert(other_session).second) {
    spdlog::warn(
        "{}: what session {} says is not taken; this one is {}", channel, other_session, session);
  }
  return true;
}

void Bus::Impl::CountMalformed(const std::string& channel, const std::string& problem) {
  ++counts[channel].num_malformed;
  ChannelMemory& memory = memories[channel];
  if (memory.has_warned) return;
  memory.has_warned = true;
  spdlog::warn("{}: malformed message skipped: {} (later ones are only counted)", channel, problem);
}

void Bus::Impl::CountLosses(const std::string& channel, std::int64_t sequence) {
  std::optional<std::int64_t>& last = memories[channel].last_sequence;
  if (last) counts[channel].num_lost += NumLostBetween(*last, sequence);
  last = sequence;
}

/// Runs under C frames that hold LCM's mutex: nothing may be thrown through them.
void Bus::Subscription::OnMessage(const lcm_recv_buf_t* buffer, const char*, void* user) {
  const auto* subscription = static_cast<const Subscription*>(user);
  try {
    subscription->impl->Deliver(*subscription, buffer->data, buffer->data_size);
  } catch (...) {
    if (!subscription->impl->thrown) subscription->impl->thrown = std::current_exception();
  }
}

Bus::Bus(const std::string& url) : impl_(std::make_unique<Impl>()) {
  const std::string used_url = url.empty() ? kDefaultLcmUrl : url;
  const std::string problem = LcmUrlProblem(used_url);
  if (!problem.empty()) throw std::runtime_error("LCM URL '" + used_url + "' " + problem);
  const auto warning = ReceiveBufferWarning(used_url, GrantedReceiveBuffer(RecvBufSize(used_url)));
  if (warning) spdlog::warn(*warning);
  impl_->lcm = lcm_create(used_url.c_str());
  if (impl_->lcm == nullptr) throw std::runtime_error(CreationProblem(used_url));
}

Bus::~Bus() { lcm_destroy(impl_->lcm); }

void Bus::SetSession(const std::string& session) { impl_->session = session; }

const std::string& Bus::session() const { return impl_->session; }

void Bus::SubscribeDecoder(const std::string& channel,
                           Queue queue,
                           std::int64_t fingerprint,
                           Decoder decoder) {
  if (channel.empty() || channel.size() > kMaxChannelLength) {
    throw std::invalid_argument("LCM channel '" + channel + "' must have 1 to " +
                                std::to_string(kMaxChannelLength) + " characters");
  }
  const bool is_first = impl_->counts.count(channel) == 0;
  if (is_first) impl_->memories[channel].fingerprint = fingerprint;
  if (impl_->memories[channel].fingerprint != fingerprint) {
    throw std::logic_error("LCM channel '" + channel + "' is already subscribed as another type");
  }
  impl_->counts[channel];  // shows in the status from now on

  auto subscription = std::make_unique<Subscription>();
  subscription->impl = impl_.get();
  subscription->channel = channel;
  subscription->queue = queue;
  subscription->keeps_counts = is_first;
  subscription->decoder = std::move(decoder);
  lcm_subscription_t* handle = lcm_subscribe(
      impl_->lcm, EscapedForRegex(channel).c_str(), &Subscription::OnMessage, subscription.get());
  if (handle == nullptr) {
    throw std::runtime_error("LCM cannot subscribe to '" + channel +
                             "': is multicast received on this network?");
  }
  lcm_subscription_set_queue_capacity(handle, queue == Queue::kState ? kNumState : kNumEvery);
  impl_->subscriptions.push_back(std::move(subscription));
}

void Bus::PublishBytes(const std::string& channel, const void* bytes, std::size_t num_bytes) {
  if (num_bytes > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    CountPublishFailure(channel, "too large for LCM");
    return;
  }
  const int status =
      lcm_publish(impl_->lcm, channel.c_str(), bytes, static_cast<unsigned int>(num_bytes));
  if (status != 0) {
    CountPublishFailure(channel, "LCM refused it");
    return;
  }
  ++impl_->num_published;
}

void Bus::CountPublishFailure(const std::string& channel, const std::string& cause) {
  if (impl_->num_publish_failures++ > 0) return;
  spdlog::warn("{}: message not published: {} (later failures are only counted)", channel, cause);
}

bool Bus::HandleOnce(std::chrono::milliseconds timeout) {
  using Rep = std::chrono::milliseconds::rep;
  const auto timeout_ms =
      static_cast<int>(std::clamp<Rep>(timeout.count(), 0, std::numeric_limits<int>::max()));
  errno = 0;
  const int status = lcm_handle_timeout(impl_->lcm, timeout_ms);
  const int cause = errno;
  if (impl_->thrown) std::rethrow_exception(std::exchange(impl_->thrown, nullptr));
  if (status < 0 && cause != EINTR) {
    throw std::runtime_error(std::string("LCM failed to handle messages: ") +
                             (cause != 0 ? std::strerror(cause) : "connection lost"));
  }
  return status > 0;
}

void Bus::HandleWaiting() {
  while (HandleOnce(std::chrono::milliseconds(0))) {
  }
}

const std::map<std::string, ChannelCounts>& Bus::channels() const { return impl_->counts; }
std::int64_t Bus::num_published() const { return impl_->num_published; }
std::int64_t Bus::num_publish_failures() const { return impl_->num_publish_failures; }

std::optional<std::string> ReceiveBufferWarning(const std::string& url,
                                                std::optional<std::int64_t> granted_bytes) {
  if (!StartsWith(url, "udpm://")) return std::nullopt;
  const std::int64_t wanted = RecvBufSize(url);
  if (wanted <= 0) {
    return "LCM URL '" + url +
           "' has no recv_buf_size: images and sweeps will be lost; add recv_buf_size=4194304";
  }
  if (!granted_bytes || *granted_bytes >= wanted) return std::nullopt;
  return "the kernel grants a receive buffer of " + std::to_string(*granted_bytes) +
         " bytes, recv_buf_size of the LCM URL asks for " + std::to_string(wanted) +
         ": images and sweeps will be lost; run: sudo sysctl -w net.core.rmem_max=" +
         std::to_string(wanted);
}

}  // namespace voqcal
