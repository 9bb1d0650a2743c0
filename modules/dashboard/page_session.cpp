#include "dashboard/page_session.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace voqcal {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

// A phone that left the network is noticed after this long, by unanswered pings.
constexpr std::chrono::seconds kIdleTimeout{20};
constexpr std::chrono::seconds kHandshakeTimeout{10};

FramePtr Refusal(const std::string& reason) {
  return TextFrame(nlohmann::json{{"kind", "refused"}, {"reason", reason}}.dump());
}

}  // namespace

PageSession::PageSession(boost::asio::ip::tcp::socket socket, std::shared_ptr<Hub> hub)
    : stream_(std::move(socket)), hub_(std::move(hub)) {
  hub_->pages.insert(this);
  ++hub_->num_pages;
  ++hub_->pairs[pair_].num_pages;
}

PageSession::~PageSession() {
  hub_->pages.erase(this);
  --hub_->num_pages;
  --hub_->pairs[pair_].num_pages;
}

void PageSession::Start(const beast::http::request<beast::http::empty_body>& upgrade) {
  stream_.read_message_max(kMaxRequestBytes);
  stream_.set_option(websocket::stream_base::timeout{kHandshakeTimeout, kIdleTimeout, true});
  Watch(pair_);
  stream_.async_accept(upgrade, [self = shared_from_this()](beast::error_code error) {
    if (error) return;
    self->SendNext();
    self->Read();
  });
}

void PageSession::HasNew(Slot slot, std::size_t pair) {
  if (pair != pair_) return;
  has_new_[static_cast<std::size_t>(slot)] = true;
  if (stream_.is_open()) SendNext();
}

void PageSession::Read() {
  stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->OnRead(error);
  });
}

// Too long a message ends the connection: Beast closes it with code 1009, "message too big".
void PageSession::OnRead(beast::error_code error) {
  if (error) return;
  Take(beast::buffers_to_string(buffer_.data()));
  buffer_.consume(buffer_.size());
  Read();
}

void PageSession::Take(const std::string& text) {
  const auto request =
      stream_.got_text() ? ParsePageRequest(text) : std::string("a request is a message of text");
  const std::string reason = request ? Do(*request) : request.error();
  if (!reason.empty()) refusal_ = Refusal(reason);
  SendNext();
}

// A number says which sample only with its pair.
std::string PageSession::Do(const PageRequest& request) {
  const std::vector<std::string>& names = hub_->options.pairs;
  for (const std::string& name : {request.watch, request.pair}) {
    const bool is_known = name.empty() || std::count(names.begin(), names.end(), name) > 0;
    if (!is_known) return "there is no pair \"" + name + "\"";
  }
  if (!request.watch.empty()) {
    const auto found = std::find(names.begin(), names.end(), request.watch);
    Watch(static_cast<std::size_t>(found - names.begin()));
  } else if (request.command.empty()) {
    is_drawing_[static_cast<std::size_t>(request.shown)] = false;
  } else if (request.command == "discard" && request.pair.empty() && names.size() > 1) {
    return "\"discard\" is of which pair?";
  } else if (!hub_->commands.Add(request)) {
    return "too many commands wait already: try again";
  }
  return "";
}

void PageSession::Watch(std::size_t pair) {
  --hub_->pairs[pair_].num_pages;
  ++hub_->pairs[pair].num_pages;
  pair_ = pair;
  for (std::size_t slot = 0; slot < kNumSlots; ++slot) {
    has_new_[slot] = hub_->pairs[pair_].newest[slot] != nullptr;
  }
  last_slot_ = kNumSlots - 1;
}

void PageSession::SendNext() {
  if (sending_) return;
  sending_ = NextFrame();
  if (!sending_) return;
  stream_.text(!sending_->is_binary);
  stream_.async_write(boost::asio::buffer(sending_->bytes),
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        self->sending_.reset();
                        if (!error) self->SendNext();
                      });
}

// The slots take turns, so that none waits for the others to fall silent.
FramePtr PageSession::NextFrame() {
  if (refusal_) return std::exchange(refusal_, nullptr);
  for (std::size_t i = 1; i <= kNumSlots; ++i) {
    const std::size_t slot = (last_slot_ + i) % kNumSlots;
    if (!has_new_[slot] || is_drawing_[slot]) continue;
    has_new_[slot] = false;
    is_drawing_[slot] = IsLarge(static_cast<Slot>(slot));
    last_slot_ = slot;
    return hub_->pairs[pair_].newest[slot];
  }
  return nullptr;
}

}  // namespace voqcal
