#include "dashboard/server.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "dashboard/http_session.hpp"
#include "dashboard/hub.hpp"

namespace voqcal {
namespace {

using boost::asio::ip::tcp;

constexpr int kMaxRequests = 64;  // at once; more are turned away

// Out of descriptors, say: to ask again at once would only spin.
constexpr std::chrono::milliseconds kWaitAfterError{200};

tcp::acceptor Listen(boost::asio::io_context* context, const ServerOptions& options) try {
  const tcp::endpoint endpoint(boost::asio::ip::make_address(options.address), options.port);
  return tcp::acceptor(*context, endpoint);  // reuses the address of a server that was killed
} catch (const boost::system::system_error& error) {
  throw std::runtime_error("cannot serve the page at " + options.address + ":" +
                           std::to_string(options.port) + ": " + error.code().message() +
                           " (dashboard: address, port in the rig file)");
}

}  // namespace

struct DashboardServer::Impl {
  explicit Impl(const ServerOptions& options)
      : hub(std::make_shared<Hub>(options)), acceptor(Listen(&context, options)) {
    port = acceptor.local_endpoint().port();
  }

  void Accept() {
    acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (error == boost::asio::error::operation_aborted) return;
      if (error) return AcceptLater(error.message());
      try {
        Serve(std::move(socket));
      } catch (const std::exception& failure) {
        return AcceptLater(failure.what());
      }
      Accept();
    });
  }

  void AcceptLater(const std::string& cause) {
    spdlog::debug("a connection was not accepted: {}", cause);
    timer.expires_after(kWaitAfterError);
    timer.async_wait([this](boost::system::error_code error) {
      if (!error) Accept();
    });
  }

  void Serve(tcp::socket socket) {
    if (hub->num_requests >= kMaxRequests) return;
    std::make_shared<HttpSession>(std::move(socket), hub)->Start();
  }

  // What one connection throws (no memory, no descriptors) costs that connection only.
  void Run() {
    while (!context.stopped()) {
      try {
        context.run();
      } catch (const std::exception& error) {
        spdlog::warn("a connection failed: {}", error.what());
      }
    }
  }

  std::shared_ptr<Hub> hub;
  boost::asio::io_context context{1};
  tcp::acceptor acceptor;
  boost::asio::steady_timer timer{context};
  std::uint16_t port = 0;
  std::thread thread;
};

DashboardServer::DashboardServer(const ServerOptions& options)
    : impl_(std::make_unique<Impl>(options)) {
  impl_->Accept();
  impl_->thread = std::thread([impl = impl_.get()] { impl->Run(); });
}

DashboardServer::~DashboardServer() {
  impl_->context.stop();
  impl_->thread.join();
}

std::uint16_t DashboardServer::port() const { return impl_->port; }
int DashboardServer::num_pages() const { return impl_->hub->num_pages; }

int DashboardServer::num_pages(std::size_t pair) const {
  return impl_->hub->pairs.at(pair).num_pages;
}

void DashboardServer::Show(Slot slot, FramePtr frame, std::size_t pair) {
  boost::asio::post(impl_->context, [hub = impl_->hub, slot, pair, frame = std::move(frame)] {
    hub->pairs.at(pair).newest.at(static_cast<std::size_t>(slot)) = frame;
    for (Page* page : hub->pages) page->HasNew(slot, pair);
  });
}

void DashboardServer::Offer(std::map<std::string, StaticFile> exports, std::size_t pair) {
  boost::asio::post(impl_->context,
                    [hub = impl_->hub, pair, exports = std::move(exports)]() mutable {
                      hub->pairs.at(pair).exports = std::move(exports);
                    });
}

std::vector<PageRequest> DashboardServer::TakeCommands() { return impl_->hub->commands.Take(); }

std::int64_t DashboardServer::num_refused_commands() const {
  return impl_->hub->commands.num_refused();
}

}  // namespace voqcal
