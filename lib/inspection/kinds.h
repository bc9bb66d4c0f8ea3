// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "inspection/inspection.h"

namespace soslam {

// Contents of an artefact of each kind; Inspect adds title and provenance. Errors as there.
Inspection InspectAssociations(const std::filesystem::path& file);
Inspection InspectEdges(const std::filesystem::path& file);
Inspection InspectLandmarks(const std::filesystem::path& file,
                            const std::optional<Sequence>& sequence);
Inspection InspectMap(const std::filesystem::path& file, const std::optional<Sequence>& sequence);
Inspection InspectMetrics(const std::filesystem::path& file);
Inspection InspectPlanes(const std::filesystem::path& file);
Inspection InspectSemanticTable(const std::filesystem::path& file);
Inspection InspectSequence(const std::filesystem::path& file);
Inspection InspectSymmetry(const std::filesystem::path& file,
                           const std::optional<Sequence>& sequence);

// The label of an object by its id; null without a sequence that has it.
Value LabelOf(const std::optional<Sequence>& sequence, int object_id);

}  // namespace soslam
