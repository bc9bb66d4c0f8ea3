// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace soslam {

// Throws InputError, naming both files, unless an artefact of this kind, JSON or HDF5, was made of
// `input`, a JSON artefact: by the SHA-256 in its header. Where the file that it was made of lies
// beside it, as in results, the message says how the two differ: "border_px: 30.0 -> 0.0". Errors
// also as CheckArtefactHeader.
void CheckWasMadeOf(const std::filesystem::path& artefact, const std::string& kind,
                    const std::filesystem::path& input);

}  // namespace soslam
