#pragma once

#include <bitset>
#include <memory>
#include <string>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "dashboard/hub.hpp"

namespace voqcal {

/// One WebSocket: sends the newest frame of each slot in turn, reads requests. Lives until the
/// connection ends; every pending operation holds it.
class PageSession : public Page, public std::enable_shared_from_this<PageSession> {
 public:
  PageSession(boost::asio::ip::tcp::socket socket, std::shared_ptr<Hub> hub);
  ~PageSession() override;
  PageSession(const PageSession&) = delete;
  PageSession& operator=(const PageSession&) = delete;

  /// Answers the upgrade that the HTTP side has read and let through.
  void Start(const boost::beast::http::request<boost::beast::http::empty_body>& upgrade);

  void HasNew(Slot slot, std::size_t pair) override;

 private:
  void Read();
  void OnRead(boost::beast::error_code error);
  void Take(const std::string& text);
  /// @return why it was refused; empty if it was done or handed over.
  std::string Do(const PageRequest& request);
  /// Shows a pair from its first slot on.
  void Watch(std::size_t pair);
  void SendNext();
  FramePtr NextFrame();

  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  std::shared_ptr<Hub> hub_;
  boost::beast::flat_buffer buffer_;
  FramePtr sending_;  ///< Null while nothing is being sent.
  FramePtr refusal_;  ///< The newest answer to a request that was refused.
  std::bitset<kNumSlots> has_new_;
  std::bitset<kNumSlots> is_drawing_;  ///< Large frames that the page has not said to have drawn.
  std::size_t last_slot_ = 0;
  std::size_t pair_ = 0;  ///< Which it shows.
};

}  // namespace voqcal
