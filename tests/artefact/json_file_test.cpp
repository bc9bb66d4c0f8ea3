// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/json_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const json kEmptyLandmarks = {
    {"observations", json::array()}, {"objects", json::array()}, {"failures", json::object()}};

class JsonFileTest : public testing::Test {
 protected:
  // What the InputError says; empty when there is none.
  template <typename Action>
  std::string InputErrorOf(const Action& action) {
    try {
      action();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string ParseErrorOf(const std::string& text) {
    std::ofstream(file) << text;
    return InputErrorOf([&] { ParseJsonFile(file); });
  }
  std::string ReadErrorWithHeader(const json& header) {
    json document = kEmptyLandmarks;
    document["artefact"] = header;
    std::ofstream(file) << document;
    return InputErrorOf([&] { ReadArtefact(file, "landmarks"); });
  }

  TemporaryFolder folder;
  std::filesystem::path file = folder / "some.json";
};

TEST_F(JsonFileTest, UnreadableTextIsRefusedOnOneLine) {
  EXPECT_THAT(InputErrorOf([&] { ParseJsonFile(folder / "none.json"); }), HasSubstr("none.json"));
  EXPECT_THAT(InputErrorOf([&] { ParseJsonFile(folder.path()); }), HasSubstr("cannot be read"));
  EXPECT_THAT(ParseErrorOf(""), HasSubstr("is empty"));
  EXPECT_THAT(ParseErrorOf("{\n\"a\": nan}"),
              AllOf(HasSubstr("some.json: parse error at line 2"), Not(HasSubstr("\n"))));
  EXPECT_THAT(ParseErrorOf("{} {}"), HasSubstr("parse error at line 1"));
  EXPECT_THAT(ParseErrorOf("{\"a\": [{\"b\": 1, \"b\": 2}]}"), HasSubstr("key \"b\" twice"));
  EXPECT_EQ(ParseErrorOf("{\"a\": {\"b\": 1}, \"b\": {\"b\": 2}}"), "");
}

TEST_F(JsonFileTest, DeepNestingIsRefused) {
  const auto nested = [](size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
  };
  EXPECT_EQ(ParseErrorOf(nested(100)), "");
  EXPECT_THAT(ParseErrorOf(nested(101)), HasSubstr("some.json: is nested more than 100 levels"));
  EXPECT_THAT(ParseErrorOf(nested(1'000'000)), HasSubstr("more than 100 levels"));
}

TEST_F(JsonFileTest, HeaderNamesWhatShapedTheArtefact) {
  std::ofstream(folder / "b.txt") << "b";
  std::ofstream(folder / "a.txt") << "abc";
  WriteArtefact(file, "landmarks", {{{"yaw", 3}}, {folder / "b.txt", folder / "a.txt"}},
                kEmptyLandmarks);
  const json header = ReadArtefact(file, "landmarks").at("artefact");
  EXPECT_EQ(header.at("kind"), "landmarks");
  EXPECT_EQ(header.at("schema_version"), json({1, 8}));
  EXPECT_THAT(header.at("software").get<std::string>(), testing::StartsWith("soslam "));
  EXPECT_EQ(header.at("settings").at("yaw"), 3);
  EXPECT_EQ(header.at("inputs").at(0).at("file"), "a.txt");
  EXPECT_EQ(header.at("inputs").at(0).at("sha256"),  // FIPS 180-2, appendix B.1
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(header.at("inputs").at(1).at("file"), "b.txt");
}

TEST_F(JsonFileTest, NamesOfFilesNeedNotBeUtf8) {
  const std::filesystem::path input = folder / "caf\xe9.txt";
  std::ofstream(input) << "bytes";
  WriteArtefact(file, "landmarks", {{{"labels", "\xe9"}}, {input}}, kEmptyLandmarks);
  const json header = ReadArtefact(file, "landmarks").at("artefact");
  EXPECT_EQ(header["inputs"][0]["file"], "caf\xef\xbf\xbd.txt");
  EXPECT_EQ(header["settings"]["labels"], "\xef\xbf\xbd");
}

TEST_F(JsonFileTest, HeadersThatAreNotOursAreRefused) {
  json header = ArtefactHeader("landmarks", {});
  EXPECT_EQ(ReadErrorWithHeader(header), "");
  header["schema_version"] = {2, 0};
  EXPECT_THAT(ReadErrorWithHeader(header),
              HasSubstr("some.json: has schema version [2, 0] of kind 'landmarks'; this software "
                        "reads up to [1, 8]"));
  header["schema_version"] = {1, 9};
  EXPECT_THAT(ReadErrorWithHeader(header), HasSubstr("[1, 8]"));
  header["schema_version"] = {1, 0};
  EXPECT_EQ(ReadErrorWithHeader(header), "");
  header["schema_version"] = "1.0";
  EXPECT_THAT(ReadErrorWithHeader(header), HasSubstr("schema_version is \"1.0\""));
  header["schema_version"] = {1, -1};
  EXPECT_THAT(ReadErrorWithHeader(header), HasSubstr("schema_version is [1,-1]"));
  EXPECT_THAT(ReadErrorWithHeader(ArtefactHeader("map", {})),
              HasSubstr("kind is \"map\"; expected \"landmarks\""));
  EXPECT_THAT(ReadErrorWithHeader(nullptr), HasSubstr("no artefact header"));
  EXPECT_THAT(ParseErrorOf("[1]"), "");
  EXPECT_THAT(InputErrorOf([&] { ReadArtefact(file, "landmarks"); }),
              HasSubstr("no artefact header"));
}

TEST_F(JsonFileTest, WritingWhatTheSchemaForbidsIsOurBug) {
  EXPECT_THROW(WriteArtefact(file, "landmarks", {}, {{"objects", 3}}), std::logic_error);
  EXPECT_THROW(WriteArtefact(file, "no such kind", {}, json::object()), std::logic_error);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(JsonFileTest, NonFiniteSettingsAreRefusedToo) {
  ExpectError<NumericalError>(
      [&] {
        WriteArtefact(file, "landmarks",
                      {{{"weight", std::numeric_limits<double>::infinity()}}, {}}, kEmptyLandmarks);
      },
      {"/artefact/settings/weight would be inf"});
}

// A misspelt keyword in a schema would silently check nothing. What has a default came after
// version 1.0 and may be absent.
TEST(SchemaTest, EverySchemaDescribesEveryField) {
  ASSERT_TRUE(EmbeddedSchemas().contains("sequence"));
  for (const char* kind : {"sequence", "landmarks", "map"}) {
    const json schema = json::parse(EmbeddedSchemas().at(kind));
    const std::function<void(const json&)> check = [&](const json& part) {
      if (part.contains("properties")) {
        EXPECT_EQ(part.at("additionalProperties"), false) << part;
        for (const auto& name : part.at("required")) {
          EXPECT_TRUE(part.at("properties").contains(name)) << kind << " " << name;
        }
        for (const auto& [name, property] : part.at("properties").items()) {
          const json& required = part.at("required");
          const bool is_required =
              std::find(required.begin(), required.end(), name) != required.end();
          EXPECT_NE(is_required, property.contains("default")) << kind << " " << name;
          EXPECT_TRUE(property.contains("description") || property.contains("$ref"))
              << kind << " " << name;
          check(property);
        }
      }
      if (part.contains("items")) check(part.at("items"));
    };
    check(schema);
    for (const auto& definition : schema.at("definitions")) check(definition);
  }
}

}  // namespace
}  // namespace soslam
