#pragma once

// Core's structs to messages and back: pure functions, no bus, no clock.
#include "messaging/convert_board.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/convert_result.hpp"
