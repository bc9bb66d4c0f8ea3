// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace soslam {

// A kind of JSON artefact.
struct ArtefactKind {
  std::string name;
  std::string title;  // what it holds
  nlohmann::ordered_json (*schema)();
  // Throws InputError with place and violation unless this is a document of the kind.
  void (*check)(const nlohmann::json& document);
};

const std::vector<ArtefactKind>& ArtefactKinds();

// Null without such a kind.
const ArtefactKind* FindArtefactKind(const std::string& name);

// The text of a file in schemas/ (JSON Schema draft 7).
std::string SchemaText(const std::string& title, const std::string& description,
                       const nlohmann::ordered_json& schema);

}  // namespace soslam
