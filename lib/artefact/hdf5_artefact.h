// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "artefact/hdf5_file.h"
#include "artefact/json_file.h"

namespace soslam {

// An HDF5 artefact carries the header of JSON artefacts (ArtefactHeader) as the text `artefact`, an
// attribute of its root.
inline constexpr const char* kHeaderAttribute = "artefact";
void WriteArtefactHeader(const std::string& kind, const ArtefactInfo& info, Hdf5File* file);

// Opens an artefact for reading. Throws InputError when it is not one of this kind, or newer than
// what this software reads.
Hdf5File OpenArtefact(const std::filesystem::path& path, const std::string& kind);

// The header of an artefact of any kind, JSON or HDF5, which what the file begins with tells, not
// its name. Throws InputError when the file is neither, or has no header that names its kind.
nlohmann::json ReadArtefactHeader(const std::filesystem::path& path);

// Whether a file begins as HDF5 files do.
bool IsHdf5(const std::filesystem::path& path);

// Pixels as an n x 2 data set of float32; `count` is how many are expected.
void WritePixels(const std::string& name, const std::vector<Eigen::Vector2f>& pixels,
                 Hdf5File* file);
std::vector<Eigen::Vector2f> ReadPixels(const Hdf5File& file, const std::string& name,
                                        int count = Hdf5File::kAny);

}  // namespace soslam
