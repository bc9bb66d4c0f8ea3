// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/dataset_content.h"
#include "dataset/import_options.h"

namespace soslam {

// Reads the tracking benchmark of KITTI, all recordings or those of the option `sequences`, as one
// dataset with a segment per recording (SSSS: its number):
//   label_02/SSSS.txt                 tracks with 2D and 3D boxes
//   calib/SSSS.txt                    P2
//   <poses>/SSSS.txt                  world_from_camera of each frame, format of KITTI's odometry
//   image_02/SSSS/FFFFFF.png          images, if present
//   <detector>/<type>/SSSS.txt        frame,x1,y1,x2,y2,score; only with option `detections`
// A frame's id is 10000 times its recording plus its own number; an object's id is 10000 times its
// recording plus its track. Each object has its own support plane with the object's id: the bottom
// face of its labelled box. Frames are 0.1 s apart. Throws InputError, SettingsError.
DatasetContent ReadKittiTracking(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam
