// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include "artefact/hdf5_artefact.h"
#include "artefact/points_file.h"
#include "fuzz/fuzz_target.h"
#include "inspection/difference.h"
#include "inspection/inspection.h"

namespace soslam {
namespace {

const FuzzTarget kHdf5("hdf5", [](const HostileInput& input) {
  const auto file = input.AsFile("artefact.h5");
  IsAccepted(file, [&] { ReadArtefactHeader(file); });
  IsAccepted(file, [&] { ReadSymmetry(file); });
  const auto points = input.Output("points.h5");
  if (IsAccepted(file, [&] { WritePoints(points, ReadPoints(file), {}); })) ReadPoints(points);
  IsAccepted(file, [&] {
    const EdgesReader reader(file);
    for (const int frame_id : reader.FrameIds()) reader.Read(frame_id);
  });
  IsAccepted(file, [&] { Inspect(file, std::nullopt); });
  IsAccepted(file, [&] { CompareArtefacts(file, file, 0.0); });
});

}  // namespace
}  // namespace soslam
