#pragma once

#include <memory>

#include "camera_driver/camera_source.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Images of a GenICam camera (GigE Vision, USB3 Vision) by Aravis, as JPEG of the rig's
/// jpeg_quality. Times are the middle of the exposure: see ExposureClock. A camera that is not
/// there, or stops giving frames, is sought again at every Next; State then says which ones are.
///
/// A frame of which packets are missing comes without bytes, so that it is counted as unreadable.
///
/// @throws std::runtime_error with the remedy if voqcal was built without Aravis.
std::unique_ptr<CameraSource> MakeGenicamSource(const Rig& rig);

}  // namespace voqcal
