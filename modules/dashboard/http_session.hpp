#pragma once

#include <memory>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "dashboard/hub.hpp"

namespace voqcal {

using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;
using HttpResponse = boost::beast::http::response<boost::beast::http::string_body>;

/// The answer to a request that is not for a WebSocket.
HttpResponse Answer(const HttpRequest& request, const Hub& hub);

/// Whether a request may become a WebSocket: the right path, token, Host and Origin, and not too
/// many pages.
bool MayOpenSocket(const HttpRequest& request, const Hub& hub);

/// One connection: reads one request and answers it, or hands the connection to a PageSession.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(boost::asio::ip::tcp::socket socket, std::shared_ptr<Hub> hub);
  ~HttpSession();
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;

  void Start();

 private:
  void OnRequest();

  boost::beast::tcp_stream stream_;
  std::shared_ptr<Hub> hub_;
  boost::beast::flat_buffer buffer_;
  boost::beast::http::request_parser<boost::beast::http::empty_body> parser_;
  HttpResponse response_;
};

}  // namespace voqcal
