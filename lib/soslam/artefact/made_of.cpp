// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <set>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// SHA-256 of what an artefact was made of; `file`: of files of this name only.
std::set<std::string> HashesOfInputs(const FileHeader& header, const std::string& file = "") {
  std::set<std::string> hashes;
  for (const FileHeader::Input& input : header.inputs) {
    if (file.empty() || input.file == file) hashes.insert(input.sha256);
  }
  return hashes;
}

FileHeader ReadHeader(const fs::path& artefact) {
  return ReadDocument<FileHeader>(ReadArtefactHeader(artefact), artefact);
}

std::string Shortened(const std::string& sha256) { return sha256.substr(0, 10); }

// The differences between two artefacts of a kind, in words.
std::string Differences(const fs::path& before, const fs::path& now) {
  const std::string old_name = ParseJsonFile(before).value("name", "");
  const std::string name = ParseJsonFile(now).value("name", "");
  if (name != old_name) return fmt::format("is of {}, not of {}", name, old_name);
  const FileHeader old_header = ReadHeader(before), header = ReadHeader(now);
  const bool are_stages_known = !header.stage.empty() && !old_header.stage.empty();
  if (are_stages_known && header.stage != old_header.stage) return "is of another stage";
  const std::vector<std::string> changes = SettingChanges(old_header.settings, header.settings);
  if (!changes.empty()) return "has other settings: " + NamesInWords(changes, 5);
  const std::set<std::string> old_hashes = HashesOfInputs(old_header);
  std::vector<std::string> files;
  for (const FileHeader::Input& input : header.inputs) {
    if (!old_hashes.contains(input.sha256)) files.push_back(input.file);
  }
  return files.empty() ? "was made anew" : "was made of another " + NamesInWords(files);
}

}  // namespace

void CheckWasMadeOf(const fs::path& artefact, const std::string& kind, const fs::path& input) {
  CheckArtefactHeader(ReadArtefactHeader(artefact), kind, artefact.string());
  const FileHeader header = ReadHeader(artefact);
  if (HashesOfInputs(header).contains(DigestOfInput(input))) return;
  const std::string name = input.filename().string();
  const std::set<std::string> expected = HashesOfInputs(header, name);
  const fs::path beside = artefact.parent_path() / name;
  const bool is_beside = Exists(beside) && expected.contains(DigestOfInput(beside));
  throw InputError(fmt::format(
      "{}: was not made of {} (SHA-256 {}{}), which {}; expected {}", artefact.string(),
      input.string(), Shortened(DigestOfInput(input)),
      expected.empty() ? "" : fmt::format(", expected {}", Shortened(*expected.begin())),
      is_beside ? Differences(beside, input) : "is of another dataset, or was made anew since",
      is_beside ? beside.string() + ", or the later stages run again"
                : "the file that it was made of, or the later stages run again"));
}

}  // namespace soslam
