#include "dashboard/http_session.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <boost/beast/websocket.hpp>

#include "dashboard/access.hpp"
#include "dashboard/page_session.hpp"

namespace voqcal {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;

constexpr std::chrono::seconds kRequestTimeout{10};
constexpr std::chrono::seconds kAnswerTimeout{60};  // the page's script is large for a bad network
constexpr std::uint32_t kMaxHeaderBytes = 8192;
constexpr char kExports[] = "export/";
constexpr int kMaxPages = 16;
constexpr char kContentPolicy[] = "Content-Security-Policy";

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

HttpResponse Plain(http::status status, const std::string& line) {
  HttpResponse response(status, 11);
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.body() = line + "\n";
  return response;
}

// Nothing of another server is loaded, and by a page that is all in one file nothing at all: its
// address has the token in it.
const std::string kSealed =
    "default-src 'none'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'; ";
const std::string kOwnPolicy = kSealed +
                               "script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
                               "connect-src 'self'";
const std::string kOneFilePolicy = kSealed +
                                   "script-src 'none'; style-src 'unsafe-inline'; img-src data:; "
                                   "connect-src 'none'";

HttpResponse Give(const std::string& name, const StaticFile& file) {
  HttpResponse response(http::status::ok, 11);
  if (file.is_one_file) response.set(kContentPolicy, kOneFilePolicy);
  response.set(http::field::content_type, file.content_type);
  if (file.is_download) {
    std::string saved_as = name;
    std::replace(saved_as.begin(), saved_as.end(), '/', '_');
    response.set(http::field::content_disposition, "attachment; filename=\"" + saved_as + "\"");
  }
  response.body() = file.bytes;
  return response;
}

/// "/TOKEN/name" without what is before the name; nothing if the token is not ours.
std::optional<std::string> PathBehindToken(std::string_view target, const std::string& token) {
  target = target.substr(0, target.find('?'));
  if (target.size() < token.size() + 2 || target.front() != '/') return {};
  if (!IsSameSecret(target.substr(1, token.size()), token)) return {};
  if (target[token.size() + 1] != '/') return {};
  return std::string(target.substr(token.size() + 2));
}

/// Why a request is refused, whatever it asks for; nothing if it is not.
std::optional<HttpResponse> Refused(const HttpRequest& request, const Hub& hub) {
  const std::string_view host = View(request[http::field::host]);
  if (!IsOwnHost(host, hub.options.host_name)) {
    return Plain(http::status::misdirected_request,
                 "open this page by its address, or name it in the rig file: dashboard: host_name");
  }
  const bool has_origin = request.find(http::field::origin) != request.end();
  if (has_origin && !IsOwnOrigin(View(request[http::field::origin]), host)) {
    return Plain(http::status::forbidden, "not from another page");
  }
  if (!PathBehindToken(View(request.target()), hub.options.token)) {
    return Plain(http::status::forbidden,
                 "the address needs the token that the dashboard prints when it starts");
  }
  return {};
}

HttpResponse AnswerUnsealed(const HttpRequest& request, const Hub& hub) {
  if (auto refusal = Refused(request, hub)) return *std::move(refusal);
  if (request.method() != http::verb::get) {
    return Plain(http::status::method_not_allowed, "only GET");
  }
  const std::string path = *PathBehindToken(View(request.target()), hub.options.token);
  const auto file = hub.options.files.find(path);
  if (file != hub.options.files.end()) return Give(path, file->second);
  if (path.compare(0, sizeof(kExports) - 1, kExports) == 0) {
    const std::string name = path.substr(sizeof(kExports) - 1);
    for (const PairInHub& pair : hub.pairs) {
      const auto exported = pair.exports.find(name);
      if (exported != pair.exports.end()) return Give(name, exported->second);
    }
  }
  return Plain(http::status::not_found, "there is nothing here");
}

}  // namespace

// The token is in the address: no cache keeps it, no link carries it on. No other page frames this
// one.
HttpResponse Answer(const HttpRequest& request, const Hub& hub) {
  HttpResponse response = AnswerUnsealed(request, hub);
  response.set(http::field::cache_control, "no-store");
  response.set("Referrer-Policy", "no-referrer");
  response.set(http::field::x_frame_options, "DENY");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  if (response.find(kContentPolicy) == response.end()) {
    response.set(kContentPolicy, kOwnPolicy);
  }
  response.keep_alive(false);
  response.prepare_payload();
  return response;
}

bool MayOpenSocket(const HttpRequest& request, const Hub& hub) {
  return request.find(http::field::origin) != request.end() && !Refused(request, hub) &&
         PathBehindToken(View(request.target()), hub.options.token) == "socket" &&
         hub.num_pages < kMaxPages;
}

HttpSession::HttpSession(boost::asio::ip::tcp::socket socket, std::shared_ptr<Hub> hub)
    : stream_(std::move(socket)), hub_(std::move(hub)) {
  parser_.header_limit(kMaxHeaderBytes);
  ++hub_->num_requests;
}

HttpSession::~HttpSession() { --hub_->num_requests; }

void HttpSession::Start() {
  stream_.expires_after(kRequestTimeout);
  http::async_read(
      stream_, buffer_, parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
        if (!error) self->OnRequest();
      });
}

void HttpSession::OnRequest() {
  const HttpRequest& request = parser_.get();
  if (beast::websocket::is_upgrade(request) && MayOpenSocket(request, *hub_)) {
    stream_.expires_never();  // the WebSocket has timeouts of its own
    std::make_shared<PageSession>(stream_.release_socket(), hub_)->Start(request);
    return;
  }
  response_ = Answer(request, *hub_);
  stream_.expires_after(kAnswerTimeout);
  http::async_write(
      stream_, response_, [self = shared_from_this()](beast::error_code error, std::size_t) {
        if (!error)
          self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
      });
}

}  // namespace voqcal
