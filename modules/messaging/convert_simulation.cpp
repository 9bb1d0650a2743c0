#include "messaging/convert_simulation.hpp"

#include <cmath>

#include "messaging/convert_result.hpp"
#include "messaging/message_error.hpp"

namespace voqcal {
namespace {

std::int64_t Utime(double time_s, std::int64_t epoch_utime) {
  return epoch_utime + std::llround(1e6 * time_s);
}

}  // namespace

simulated_board_t ToMessage(const GuidedBoard& board, std::int64_t epoch_utime) {
  simulated_board_t message{};
  message.utime = Utime(board.decided_until_s(), epoch_utime);
  if (board.end_s()) message.end_utime = Utime(*board.end_s(), epoch_utime);
  message.num_stops = static_cast<std::int32_t>(board.stops().size());
  for (const BoardStop& stop : board.stops()) {
    message.leave_utime.push_back(Utime(stop.leave_s, epoch_utime));
    message.T_lidar_board.push_back(ToMessage(stop.T_lidar_board));
  }
  return message;
}

std::vector<BoardStop> StopsFromMessage(const simulated_board_t& message,
                                        std::int64_t epoch_utime) {
  if (message.num_stops < 1) throw MessageError("a simulated board without a stop");
  std::vector<BoardStop> stops;
  for (std::size_t i = 0; i < message.leave_utime.size(); ++i) {
    stops.push_back({1e-6 * static_cast<double>(message.leave_utime[i] - epoch_utime),
                     FromMessage(message.T_lidar_board[i])});
  }
  return stops;
}

}  // namespace voqcal
