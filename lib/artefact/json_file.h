// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <istream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "model/finding.h"

namespace soslam {

// What is not there is null in every artefact.
template <typename Value>
nlohmann::json OrNull(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

// What shaped an artefact.
struct ArtefactInfo {
  nlohmann::json settings;                    // every option of the stage, resolved
  std::vector<std::filesystem::path> inputs;  // the files that were read
  std::vector<Finding> findings = {};         // of the stage that writes it
};

// The document in a JSON file of anybody's. Throws InputError, naming the file and line, when it is
// missing, empty or malformed, nested deeper than any file of ours, or an object has the same key
// twice.
nlohmann::json ParseJsonFile(const std::filesystem::path& path);
// The same of a text that is not a file of its own; `name` stands for it in error messages.
nlohmann::json ParseJsonText(std::istream& text, const std::string& name);

// A value as text in ASCII, cut to what fits on a line.
std::string Excerpt(const nlohmann::json& value);

// What every header begins with: kind, schema version, software version.
nlohmann::json HeaderOfKind(const std::string& kind);

// The header of an artefact: kind, schema version, software version, settings, and each input by
// file name with its SHA-256. JSON artefacts hold it as "artefact", HDF5 artefacts as an attribute.
nlohmann::json ArtefactHeader(const std::string& kind, const ArtefactInfo& info);

// Throws InputError, naming `file`, when the header is not one of this kind, or its schema version
// is newer than what this software reads.
void CheckArtefactHeader(const nlohmann::json& header, const std::string& kind,
                         const std::string& file);

// An artefact of that kind, checked against schemas/<kind>.schema.json, with its header under
// "artefact". Throws InputError.
nlohmann::json ReadArtefact(const std::filesystem::path& path, const std::string& kind);

// The artefact as `from_json` builds it; InputErrors that `from_json` throws get the file's name.
template <typename FromJson>
auto ReadArtefactAs(const std::filesystem::path& path, const std::string& kind,
                    const FromJson& from_json) {
  const nlohmann::json document = ReadArtefact(path, kind);
  try {
    return from_json(document);
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

// Writes {"artefact": header, "findings": if any, ...body} atomically; an existing file with the
// same bytes keeps its modification time. Throws NumericalError, naming the place, for a number
// that is not finite; SettingsError when the file cannot be written; std::logic_error when the
// schema does not allow it.
void WriteArtefact(const std::filesystem::path& path, const std::string& kind,
                   const ArtefactInfo& info, nlohmann::json body);

}  // namespace soslam
