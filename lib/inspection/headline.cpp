// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/headline.h"

#include <fmt/format.h>

#include <vector>

#include "artefact/landmarks_file.h"
#include "artefact/world_file.h"
#include "base/paths.h"
#include "base/text.h"
#include "inspection/doubts.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// ", scale ... (uncertain: ...)"; empty for a world whose scale is given.
std::string ScaleInHeadline(const fs::path& world, const Sequence& sequence) {
  constexpr const char* kUnknown = ", scale unknown";
  if (!Exists(world)) return IsInMetresWithoutWorld(sequence) ? "" : kUnknown;
  const auto scale = ScaleOfWorld(ReadArtefact(world, "world"));
  if (!scale) return kUnknown;
  const std::string contradictions = ContradictionsInWords(*scale);
  return fmt::format(", scale +- {:.0f} %{}", HalfIntervalPercent(*scale),
                     contradictions.empty() ? "" : fmt::format(" (uncertain: {})", contradictions));
}

}  // namespace

std::string HeadlineOfMap(const fs::path& map, const Sequence& sequence) {
  const MapEstimate estimate = ReadMap(map, sequence);
  const std::vector<std::string> doubts = DoubtsOfMap(map.parent_path(), estimate, sequence);
  size_t placed = 0, uncertain = 0;
  for (size_t i = 0; i < estimate.objects.size(); ++i) {
    if (!estimate.objects[i].landmark_in_world) continue;
    ++placed;
    if (!doubts[i].empty()) ++uncertain;
  }
  std::string line =
      Counted(placed, "object") + ScaleInHeadline(map.parent_path() / "world.json", sequence);
  if (uncertain > 0) line += fmt::format(", {} uncertain", Counted(uncertain, "object"));
  return line;
}

}  // namespace soslam
