// SPDX-License-Identifier: BSD-3-Clause
// Schemas are generated from the descriptions of what files hold.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "soslam/artefact/described_json.h"
#include "soslam/artefact/json_file.h"
#include "soslam/artefact/kinds.h"
#include "soslam/artefact/run_file.h"
#include "soslam/base/error.h"
#include "soslam/model/describe_estimates.h"
#include "soslam/model/edits.h"
#include "soslam/priors/furniture_catalogue.h"
#include "soslam/report/tables.h"
#include "soslam/synthesis/scene.h"
#include "support/random_estimates.h"
#include "support/schema_violation.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// All files of schemas/, by name.
std::map<std::string, std::string> GeneratedSchemas() {
  std::map<std::string, std::string> schemas;
  const auto add = [&](const std::string& name, const std::string& description,
                       const nlohmann::ordered_json& schema) {
    schemas[name + ".schema.json"] = SchemaText(name, description, schema);
  };
  for (const ArtefactKind& kind : ArtefactKinds()) add(kind.name, kind.title, kind.schema());
  add("run", "one run of a stage: what it was made with and from", RunSchema());
  add("timing", "how long one run of a stage took", SchemaWriter::Of<StageTiming>());
  add("about", "what tables say of a dataset: the field about of its settings",
      SchemaWriter::Of<AboutDataset>());
  add("published", "values that a publication prints, beside measured ones",
      SchemaWriter::Of<Published>());
  add("furniture_labels", "which models of a furniture catalogue count as which label",
      SchemaWriter::Of<CatalogueLabels>());
  add("edits", "corrections of data association by hand", SchemaWriter::Of<Edits>());
  add("scene", "what soslam-synthesise makes a dataset from; metres, angles in degrees",
      SchemaWriter::Of<Scene>());
  return schemas;
}

TEST(SchemasTest, AreThoseOfTheDescriptions) {
  const fs::path folder = fs::path(SOSLAM_SOURCE_DIR) / "schemas";
  const bool writes = std::getenv("SOSLAM_WRITE_SCHEMAS") != nullptr;
  const std::map<std::string, std::string> generated = GeneratedSchemas();
  for (const auto& [name, text] : generated) {
    if (writes) WriteBytes(folder / name, text);
    EXPECT_TRUE(FileBytes(folder / name) == text)
        << name
        << ": schemas/ is generated: SOSLAM_WRITE_SCHEMAS=1 build/bin/report_test "
           "--gtest_filter='SchemasTest.*' makes it again";
  }
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") {
      EXPECT_TRUE(generated.contains(entry.path().filename().string())) << entry.path();
    }
  }
}

// Every field is explained, and what may be absent is not required.
void CheckPart(const json& part, const std::string& place) {
  if (part.contains("properties")) {
    EXPECT_EQ(part.at("additionalProperties"), false) << place;
    for (const auto& name : part.at("required")) {
      EXPECT_TRUE(part.at("properties").contains(name)) << place << name;
    }
    for (const auto& [name, property] : part.at("properties").items()) {
      EXPECT_NE(property.value("description", ""), "") << place << "/" << name;
      CheckPart(property, place + "/" + name);
    }
  }
  if (part.contains("items")) CheckPart(part.at("items"), place + "/*");
}

TEST(SchemasTest, ExplainEveryField) {
  for (const auto& [name, text] : GeneratedSchemas()) CheckPart(json::parse(text), name);
}

// What a reader takes, a validator that is not ours takes as well, and the other way round.
TEST(SchemasTest, TakeWhatReadersTake) {
  const Sequence sequence = RandomSequence();
  const std::map<std::string, json> bodies = {
      {"sequence", DescribedToJson(sequence, &sequence)},
      {"landmarks", DescribedToJson(RandomLandmarkEstimates(), &sequence)},
      {"map", DescribedToJson(RandomMap(), &sequence)}};
  for (const auto& [kind, body] : bodies) {
    const ArtefactKind& described = *FindArtefactKind(kind);
    const json schema = json::parse(SchemaText(kind, "", described.schema()));
    json document = json::parse(ArtefactText("test", kind, {}, body));
    EXPECT_EQ(ViolationOf(document, schema), std::nullopt) << kind;
    // Each field in turn is missing, null, of another type, or joined by another one.
    const json places = document.flatten();
    for (const auto& [place, value] : places.items()) {
      const json::json_pointer pointer(place);
      for (const json& other : {json(), json("text"), json(-1.5), json(json::object()), json(0)}) {
        json edited = document;
        edited[pointer] = other;
        bool is_taken = true;
        try {
          described.check(edited);
        } catch (const InputError&) {
          is_taken = false;
        }
        // What no schema expresses is not compared.
        if (!is_taken) continue;
        EXPECT_EQ(ViolationOf(edited, schema), std::nullopt) << place << " " << other;
      }
    }
  }
}

}  // namespace
}  // namespace soslam
