// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "soslam/cli/command_line.h"
#include "soslam/exchange/world.h"
#include "soslam/model/finding.h"
#include "soslam/model/sequence.h"

namespace soslam {

// What soslam-export makes of the images in folder "dataset", whose paths are those of the
// sequence. All throw as FrameImages and FrameImageReader.

// Gives the points the mean colour of their pixels.
void ColourPoints(const Sequence& sequence, const StageFiles& files, int threads,
                  std::vector<World>* worlds);

// Writes each image with the bodies of its world as a JPEG file into folder "overlays", in the size
// of DrawingGround, without lens distortion. It has the name of the image within FolderOfImages,
// with .jpg as extension, which is appended where two images differ by theirs alone. Returns the
// number of files.
size_t WriteOverlays(const Sequence& sequence, const std::vector<World>& worlds,
                     const StageFiles& files, int threads);

// Images that EXIF turns, of a sequence whose cameras are those of upright images: other programs
// read them as they are stored.
std::vector<Finding> CheckTurnedImages(const Sequence& sequence, const StageFiles& files);

}  // namespace soslam
