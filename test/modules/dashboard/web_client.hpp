#pragma once

#include <chrono>
#include <stdexcept>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

namespace voqcal::test {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::asio::ip::tcp;

/// What a client says of itself; empty: the header is left out.
struct Headers {
  std::string host = "127.0.0.1";
  std::string origin;
};

inline tcp::socket Connected(boost::asio::io_context* context, std::uint16_t port) {
  tcp::socket socket(*context);
  socket.connect({boost::asio::ip::make_address("127.0.0.1"), port});
  return socket;
}

/// One request, and the answer to it.
inline http::response<http::string_body> Request(std::uint16_t port,
                                                 const std::string& target,
                                                 const Headers& headers = {},
                                                 http::verb method = http::verb::get) {
  boost::asio::io_context context;
  tcp::socket socket = Connected(&context, port);
  http::request<http::empty_body> request(method, target, 11);
  if (!headers.host.empty()) request.set(http::field::host, headers.host);
  if (!headers.origin.empty()) request.set(http::field::origin, headers.origin);
  http::write(socket, request);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(socket, buffer, response);
  return response;
}

/// A page's end of the WebSocket. Every read gives up after some seconds.
class SocketClient {
 public:
  /// @throws boost::system::system_error if the upgrade is refused.
  SocketClient(std::uint16_t port, const std::string& target, const Headers& headers)
      : stream_(Connected(&context_, port)) {
    stream_.set_option(beast::websocket::stream_base::decorator(
        [&headers](beast::websocket::request_type& request) {
          if (!headers.origin.empty()) request.set(http::field::origin, headers.origin);
        }));
    stream_.handshake(headers.host, target);
  }

  void Send(const std::string& text) { stream_.write(boost::asio::buffer(text)); }
  void SendBinary(const std::string& bytes) {
    stream_.binary(true);
    stream_.write(boost::asio::buffer(bytes));
    stream_.binary(false);
  }

  /// The next message.
  /// @throws boost::system::system_error when the server closed the connection, or after a wait.
  std::string Read() {
    beast::get_lowest_layer(stream_).expires_after(std::chrono::seconds(10));
    beast::flat_buffer buffer;
    boost::system::error_code result = boost::asio::error::would_block;
    stream_.async_read(buffer,
                       [&result](boost::system::error_code error, std::size_t) { result = error; });
    context_.restart();
    context_.run();
    if (result) throw boost::system::system_error(result);
    return beast::buffers_to_string(buffer.data());
  }

  /// The header of the next message, which is JSON or begins with it.
  nlohmann::json ReadHeader() {
    const std::string message = Read();
    if (stream_.got_text()) return nlohmann::json::parse(message);
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length |= static_cast<std::size_t>(static_cast<unsigned char>(message.at(i))) << (8 * i);
    return nlohmann::json::parse(message.substr(4, length));
  }

  beast::websocket::close_code CloseCode() const {
    return static_cast<beast::websocket::close_code>(stream_.reason().code);
  }

 private:
  boost::asio::io_context context_;
  beast::websocket::stream<beast::tcp_stream> stream_;
};

}  // namespace voqcal::test
