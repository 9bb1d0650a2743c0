#pragma once

#include <memory>

#include "camera_driver/camera_source.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Images by OpenCV's VideoCapture: a V4L2 device, a GStreamer pipeline, or a URL or file by
/// FFmpeg. What cannot be opened, or stops giving frames, is opened again at every Next.
///
/// MJPEG is passed on as it comes; other frames are compressed with the rig's jpeg_quality. Frames
/// of a file have the file's times, from kSyntheticEpochUtime; those of a device the kernel's time
/// of the buffer; those of a stream see CaptureClock.
std::unique_ptr<CameraSource> MakeVideoSource(const CameraDriverOptions& options);

}  // namespace voqcal
