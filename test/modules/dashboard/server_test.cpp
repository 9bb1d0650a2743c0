#include "dashboard/server.hpp"

#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "modules/dashboard/web_client.hpp"

namespace voqcal {
namespace {

using test::Headers;
using test::Request;
using test::SocketClient;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string kToken(64, 'a');

ServerOptions TestOptions() {
  ServerOptions options;
  options.token = kToken;
  options.host_name = "cart.local";
  options.files = {{"", {"text/html", "the page"}}, {"dashboard.js", {"text/javascript", "code"}}};
  return options;
}

FramePtr Numbered(Slot slot, int number) {
  return TextFrame(Json{{"kind", ToString(slot)}, {"number", number}}.dump());
}

class DashboardServerTest : public ::testing::Test {
 protected:
  std::string Host() const { return "127.0.0.1:" + std::to_string(server_.port()); }
  std::string Path(const std::string& name) const { return "/" + kToken + "/" + name; }
  Headers PageHeaders() const { return {Host(), "http://" + Host()}; }
  int StatusOf(const std::string& target, const Headers& headers = {}) const {
    return static_cast<int>(Request(server_.port(), target, headers).result_int());
  }
  SocketClient Page() const { return {server_.port(), Path("socket"), PageHeaders()}; }
  void ExpectNoSocket(const std::string& target, const Headers& headers) const {
    EXPECT_THROW(SocketClient(server_.port(), target, headers), boost::system::system_error)
        << target;
    EXPECT_EQ(server_.num_pages(), 0);
  }
  /// Waits for what the server's thread does; a test that waits for ever is ended by ctest.
  template <typename Condition>
  static void Await(const Condition& condition) {
    while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  DashboardServer server_{TestOptions()};
};

TEST_F(DashboardServerTest, GivesThePageToWhoKnowsTheToken) {
  const auto page = Request(server_.port(), Path(""), {Host(), ""});
  EXPECT_EQ(page.result_int(), 200U);
  EXPECT_EQ(page.body(), "the page");
  EXPECT_EQ(page[test::http::field::cache_control], "no-store");
  EXPECT_EQ(page["Referrer-Policy"], "no-referrer");
  EXPECT_THAT(std::string(page["Content-Security-Policy"]), HasSubstr("default-src 'none'"));
  EXPECT_EQ(Request(server_.port(), Path("dashboard.js?v=1"), {Host(), ""}).body(), "code");
}

TEST_F(DashboardServerTest, GivesNothingWithoutTheToken) {
  std::string wrong = kToken;
  wrong.back() = 'b';
  for (const std::string& target : {std::string("/"),
                                    "/" + wrong + "/",
                                    "/" + kToken,
                                    "/" + kToken + "x/",
                                    std::string("/dashboard.js"),
                                    "/?token=" + kToken,
                                    "//" + kToken + "/"}) {
    EXPECT_EQ(StatusOf(target, {Host(), ""}), 403) << target;
  }
}

TEST_F(DashboardServerTest, GivesNoOtherPath) {
  for (const char* name : {"../etc/passwd",
                           "export/../dashboard.js",
                           "/etc/passwd",
                           "export//etc/passwd",
                           "%2e%2e/%2e%2e/etc/passwd",
                           "..%2f..%2fetc%2fpasswd",
                           "dashboard.js/",
                           "export/",
                           "export/extrinsic.yaml",
                           "socket",
                           "samples.lcm",
                           "dashboard.js%00.html"}) {
    EXPECT_EQ(StatusOf(Path(name), {Host(), ""}), 404) << name;
  }
}

TEST_F(DashboardServerTest, RefusesAnotherHost) {
  EXPECT_EQ(StatusOf(Path(""), {"cart.local:80", ""}), 200);
  EXPECT_EQ(StatusOf(Path(""), {"evil.example:8765", ""}), 421);
  EXPECT_EQ(StatusOf(Path(""), {"", ""}), 421);
  ExpectNoSocket(Path("socket"), {"evil.example", "http://evil.example"});
}

TEST_F(DashboardServerTest, RefusesAnotherOrigin) {
  EXPECT_EQ(StatusOf(Path(""), {Host(), "http://evil.example"}), 403);
  EXPECT_EQ(StatusOf(Path(""), {Host(), "null"}), 403);
  ExpectNoSocket(Path("socket"), {Host(), "http://evil.example"});
  ExpectNoSocket(Path("socket"), {Host(), "null"});
  ExpectNoSocket(Path("socket"), {Host(), ""});  // browsers always send one with a WebSocket
  ExpectNoSocket("/socket", PageHeaders());
  ExpectNoSocket(Path(""), PageHeaders());
}

TEST_F(DashboardServerTest, OnlyAnswersGet) {
  for (const auto method :
       {test::http::verb::post, test::http::verb::put, test::http::verb::delete_}) {
    EXPECT_EQ(Request(server_.port(), Path(""), {Host(), ""}, method).result_int(), 405U);
  }
}

TEST_F(DashboardServerTest, DropsWhatIsNoHttp) {
  boost::asio::io_context context;
  for (const std::string& bytes :
       {std::string("\x16\x03\x01 hello\r\n\r\n"),
        std::string(20000, 'x'),
        "GET / HTTP/1.1\r\nX: " + std::string(20000, 'x') + "\r\n\r\n"}) {
    test::tcp::socket socket = test::Connected(&context, server_.port());
    boost::system::error_code error;
    boost::asio::write(socket, boost::asio::buffer(bytes), error);
    std::string answer;
    boost::asio::read(socket, boost::asio::dynamic_buffer(answer), error);
    EXPECT_EQ(answer, "");
  }
  EXPECT_EQ(StatusOf(Path(""), {Host(), ""}), 200);  // it still serves
}

TEST_F(DashboardServerTest, OffersExportsAsDownloads) {
  server_.Offer({{"extrinsic.yaml", {"text/plain", "T: 1", true}}});
  const auto file = Request(server_.port(), Path("export/extrinsic.yaml"), {Host(), ""});
  EXPECT_EQ(file.body(), "T: 1");
  EXPECT_EQ(file[test::http::field::content_disposition],
            "attachment; filename=\"extrinsic.yaml\"");
  server_.Offer({});
  EXPECT_EQ(StatusOf(Path("export/extrinsic.yaml"), {Host(), ""}), 404);
}

TEST_F(DashboardServerTest, TellsANewPageWhatIsShown) {
  server_.Show(Slot::kSamples, Numbered(Slot::kSamples, 1));
  server_.Show(Slot::kSamples, Numbered(Slot::kSamples, 2));
  SocketClient page = Page();
  EXPECT_EQ(page.ReadHeader()["number"], 2);
  server_.Show(Slot::kResult, Numbered(Slot::kResult, 3));
  EXPECT_EQ(page.ReadHeader()["number"], 3);
}

// An image is held back until the page has drawn the last; what came meanwhile is never sent.
TEST_F(DashboardServerTest, TheLatestImageWins) {
  SocketClient page = Page();
  Await([this] { return server_.num_pages() == 1; });
  server_.Show(Slot::kImage, Numbered(Slot::kImage, 0));
  EXPECT_EQ(page.ReadHeader()["number"], 0);
  for (int i = 1; i <= 100; ++i) server_.Show(Slot::kImage, Numbered(Slot::kImage, i));
  server_.Show(Slot::kSamples, Numbered(Slot::kSamples, 1000));
  EXPECT_EQ(page.ReadHeader()["number"], 1000);  // others are not held back
  page.Send(R"({"shown": "cloud"})");
  page.Send(R"({"shown": "image"})");
  EXPECT_EQ(page.ReadHeader()["number"], 100);
}

TEST_F(DashboardServerTest, ASlowPageDelaysNoOther) {
  SocketClient slow = Page();
  SocketClient fast = Page();
  Await([this] { return server_.num_pages() == 2; });
  for (int i = 0; i < 50; ++i) {
    server_.Show(Slot::kImage, Numbered(Slot::kImage, i));
    EXPECT_EQ(fast.ReadHeader()["number"], i);
    fast.Send(R"({"shown": "image"})");
  }
  EXPECT_EQ(slow.ReadHeader()["number"], 0);
  slow.Send(R"({"shown": "image"})");
  EXPECT_EQ(slow.ReadHeader()["number"], 49);
}

// Megabytes for a page that reads nothing: no more than the newest is kept for it.
TEST_F(DashboardServerTest, APageThatDoesNotReadCostsOneFrameOfEachSlot) {
  const SocketClient deaf = Page();
  Await([this] { return server_.num_pages() == 1; });
  std::vector<std::weak_ptr<const Frame>> frames;
  for (int i = 0; i < 200; ++i) {
    const auto frame = std::make_shared<const Frame>(Frame{true, std::string(1U << 20U, 'x')});
    frames.push_back(frame);
    server_.Show(Slot::kCloud, frame);
  }
  const auto num_kept = [&frames] {
    return std::count_if(
        frames.begin(), frames.end(), [](const auto& frame) { return !frame.expired(); });
  };
  Await([&] { return num_kept() <= 2; });  // one on its way to the page, and the newest
}

TEST_F(DashboardServerTest, HandsCommandsOver) {
  SocketClient page = Page();
  page.Send(R"({"command": "capture"})");
  page.Send(R"({"command": "discard", "sample_id": 3})");
  std::vector<PageRequest> commands;
  Await([&] {
    for (const PageRequest& each : server_.TakeCommands()) commands.push_back(each);
    return commands.size() == 2;
  });
  EXPECT_EQ(commands[0].command, "capture");
  EXPECT_EQ(commands[1].command, "discard");
  EXPECT_EQ(commands[1].sample_id, 3);
}

// A hundred commands may wait, which nobody takes here.
TEST_F(DashboardServerTest, RefusesMoreCommandsThanAnybodyClicks) {
  SocketClient page = Page();
  for (int i = 0; i < 101; ++i) page.Send(R"({"command": "capture"})");
  EXPECT_THAT(page.ReadHeader()["reason"].get<std::string>(), HasSubstr("too many commands"));
  EXPECT_EQ(server_.TakeCommands().size(), 100U);
  EXPECT_EQ(server_.num_refused_commands(), 1);
}

/// While it lives, this process can open no more files or connections.
class NoDescriptors {
 public:
  NoDescriptors() {
    EXPECT_EQ(getrlimit(RLIMIT_NOFILE, &before_), 0);
    const rlimit none{0, before_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  }
  ~NoDescriptors() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

 private:
  rlimit before_{};
};

TEST_F(DashboardServerTest, ServesAgainOnceThereAreDescriptors) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "UBSan's check of an object's type needs a descriptor itself";
#endif
  boost::asio::io_context context;
  test::tcp::socket waiting(context, test::tcp::v4());
  {
    const NoDescriptors no_descriptors;
    waiting.connect({boost::asio::ip::make_address("127.0.0.1"), server_.port()});
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // for the server to fail in
  }
  boost::asio::write(waiting, boost::asio::buffer(std::string("GET / HTTP/1.1\r\n\r\n")));
  std::string answer;
  boost::system::error_code error;
  boost::asio::read(waiting, boost::asio::dynamic_buffer(answer), error);
  EXPECT_THAT(answer, HasSubstr("421"));  // it has no Host
  EXPECT_EQ(StatusOf(Path(""), {Host(), ""}), 200);
}

TEST_F(DashboardServerTest, RefusesMalformedRequestsWithoutEffect) {
  SocketClient page = Page();
  page.Send("{\"command\": ");
  EXPECT_EQ(page.ReadHeader(), (Json{{"kind", "refused"}, {"reason", "the request is no JSON"}}));
  page.SendBinary(R"({"command": "reset"})");
  EXPECT_THAT(page.ReadHeader()["reason"].get<std::string>(), HasSubstr("text"));
  page.Send(R"({"command": "capture"})");  // the connection still serves
  std::vector<PageRequest> commands;
  Await([&] { return !(commands = server_.TakeCommands()).empty(); });
  EXPECT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].command, "capture");
}

TEST_F(DashboardServerTest, ClosesOnAnOversizedFrame) {
  SocketClient page = Page();
  page.Send(std::string(kMaxRequestBytes + 1, ' '));
  EXPECT_THROW(page.Read(), boost::system::system_error);
  EXPECT_EQ(page.CloseCode(), test::beast::websocket::close_code::too_big);
  Await([this] { return server_.num_pages() == 0; });
  EXPECT_TRUE(server_.TakeCommands().empty());
}

TEST_F(DashboardServerTest, TurnsAwayMorePagesThanItServes) {
  std::vector<std::unique_ptr<SocketClient>> pages;
  for (int i = 0; i < 16; ++i) {
    pages.push_back(std::make_unique<SocketClient>(server_.port(), Path("socket"), PageHeaders()));
    Await([&] { return server_.num_pages() == i + 1; });
  }
  EXPECT_THROW(Page(), boost::system::system_error);
  pages.pop_back();
  Await([this] { return server_.num_pages() == 15; });
  EXPECT_NO_THROW(Page());
}

// Which begins with what the pair is, and has nothing of another.
TEST(DashboardServer, ShowsAPageThePairThatItAsksFor) {
  ServerOptions options = TestOptions();
  options.pairs = {"front", "rear"};
  DashboardServer server(options);
  const std::string host = "127.0.0.1:" + std::to_string(server.port());
  SocketClient page(server.port(), "/" + kToken + "/socket", {host, "http://" + host});
  for (std::size_t pair = 0; pair < 2; ++pair) {
    for (const Slot slot : {Slot::kSamples, Slot::kRig}) {
      server.Show(slot, Numbered(slot, static_cast<int>(pair)), pair);
    }
    server.Offer({{options.pairs[pair] + "/file", {"text/plain", options.pairs[pair], true}}},
                 pair);
  }
  for (int i = 0; i < 2; ++i) EXPECT_EQ(page.ReadHeader()["number"], 0);
  page.Send(R"({"watch": "rear"})");
  EXPECT_EQ(page.ReadHeader(), Json({{"kind", "rig"}, {"number", 1}}));
  EXPECT_EQ(page.ReadHeader(), Json({{"kind", "samples"}, {"number", 1}}));
  EXPECT_EQ(server.num_pages(), 1);
  EXPECT_EQ(server.num_pages(0), 0);
  EXPECT_EQ(server.num_pages(1), 1);
  page.Send(R"({"watch": "left"})");
  EXPECT_THAT(page.ReadHeader()["reason"].get<std::string>(), HasSubstr("no pair \"left\""));
  page.Send(R"({"command": "reset", "pair": "left"})");
  EXPECT_THAT(page.ReadHeader()["reason"].get<std::string>(), HasSubstr("no pair \"left\""));
  page.Send(R"({"command": "discard", "sample_id": 1})");
  EXPECT_THAT(page.ReadHeader()["reason"].get<std::string>(), HasSubstr("which pair"));
  EXPECT_TRUE(server.TakeCommands().empty());
  const auto file = Request(server.port(), "/" + kToken + "/export/rear/file", {host, ""});
  EXPECT_EQ(file.body(), "rear");
  EXPECT_THAT(std::string(file["Content-Disposition"]), HasSubstr("\"rear_file\""));
}

TEST(DashboardServer, SaysWhyItCannotListen) {
  const DashboardServer first(TestOptions());
  ServerOptions options = TestOptions();
  options.port = first.port();
  try {
    const DashboardServer second(options);
    FAIL() << "two servers at one port";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("127.0.0.1:" + std::to_string(first.port())));
    EXPECT_THAT(error.what(), HasSubstr("in use"));
  }
}

TEST(DashboardServer, TakesItsPortAgainAfterPagesWereOpen) {
  ServerOptions options = TestOptions();
  auto server = std::make_unique<DashboardServer>(options);
  options.port = server->port();
  const std::string host = "127.0.0.1:" + std::to_string(options.port);
  const SocketClient page(options.port, "/" + kToken + "/socket", {host, "http://" + host});
  server.reset();
  EXPECT_NO_THROW(DashboardServer{options});
}

}  // namespace
}  // namespace voqcal
