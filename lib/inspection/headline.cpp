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

std::string InBrackets(const std::string& doubts) {
  return doubts.empty() ? "" : fmt::format(" (uncertain: {})", doubts);
}

// ", scale ... (uncertain: ...), up (uncertain: ...)", up only if it is uncertain; empty for
// a world whose scale is given.
std::string WorldInHeadline(const fs::path& path, const Sequence& sequence) {
  constexpr const char* kUnknown = ", scale unknown";
  if (!Exists(path)) return IsInMetresWithoutWorld(sequence) ? "" : kUnknown;
  const nlohmann::json world = ReadArtefact(path, "world");
  std::string words = kUnknown;
  if (const auto scale = ScaleOfWorld(world)) {
    words = fmt::format(", scale +- {:.0f} %{}", HalfIntervalPercent(*scale),
                        InBrackets(ContradictionsInWords(*scale)));
  }
  const std::string doubt = DoubtOfUp(world);
  return doubt.empty() ? words : words + ", up" + InBrackets(doubt);
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
      Counted(placed, "object") + WorldInHeadline(map.parent_path() / "world.json", sequence);
  if (uncertain > 0) line += fmt::format(", {} uncertain", Counted(uncertain, "object"));
  return line;
}

}  // namespace soslam
