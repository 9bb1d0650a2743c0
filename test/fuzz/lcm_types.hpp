#pragma once

#include <tuple>

#include "voqcal/assessment_t.hpp"
#include "voqcal/camera_board_t.hpp"
#include "voqcal/camera_info_t.hpp"
#include "voqcal/command_t.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/extrinsic_averaged_t.hpp"
#include "voqcal/extrinsic_refined_t.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/lidar_board_t.hpp"
#include "voqcal/module_status_t.hpp"
#include "voqcal/pointcloud2_t.hpp"
#include "voqcal/raw_t.hpp"
#include "voqcal/rigid_transform_t.hpp"
#include "voqcal/sample_t.hpp"
#include "voqcal/samples_t.hpp"
#include "voqcal/voq_sets_t.hpp"

namespace voqcal::fuzz {

/// Every type that is sent on a channel. An input's first byte is its place here: append only.
using LcmTypes = std::tuple<assessment_t,
                            camera_board_t,
                            camera_info_t,
                            command_t,
                            event_t,
                            extrinsic_averaged_t,
                            extrinsic_refined_t,
                            image_t,
                            lidar_board_t,
                            module_status_t,
                            pointcloud2_t,
                            raw_t,
                            rigid_transform_t,
                            sample_t,
                            samples_t,
                            voq_sets_t>;

}  // namespace voqcal::fuzz
