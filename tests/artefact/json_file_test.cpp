// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/json_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"

namespace soslam {
namespace {

using nlohmann::json;

const json kEmptyLandmarks = {
    {"observations", json::array()}, {"objects", json::array()}, {"failures", json::object()}};

class JsonFileTest : public FolderTest {
 protected:
  json Parse(const std::string& text) const { return ParseJsonFile(Write("some.json", text)); }
  json ReadWithHeader(const json& header) const {
    json document = kEmptyLandmarks;
    document["artefact"] = header;
    return ReadArtefact(Write("some.json", document.dump()), "landmarks");
  }
  static json HeaderOfVersion(const json& version) {
    json header = ArtefactHeader("landmarks", {});
    header["schema_version"] = version;
    return header;
  }

  std::filesystem::path file = folder_ / "some.json";
};

TEST_F(JsonFileTest, UnreadableTextIsRefused) {
  const auto nested = [](size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
  };
  ExpectBadTexts({{"", {"is empty"}},
                  {"{\n\"a\": nan}", {"parse error at line 2"}},
                  {"{} {}", {"parse error at line 1"}},
                  {"{\"a\": [{\"b\": 1, \"b\": 2}]}", {"key \"b\" twice"}},
                  {"\x89HDF\r\n\x1a\n", {"is an HDF5 file; expected JSON"}},
                  {"<html>", {"is an HTML page"}},
                  {nested(101), {"is nested more than 100 levels"}},
                  {nested(1'000'000), {"is nested more than 100 levels"}}},
                 "some.json: ", [&](const std::string& text) { Parse(text); });
  EXPECT_NO_THROW(Parse("{\"a\": {\"b\": 1}, \"b\": {\"b\": 2}}"));
  EXPECT_NO_THROW(Parse(nested(100)));
  ExpectError<InputError>([&] { ParseJsonFile(folder_ / "none.json"); }, {"none.json"});
  ExpectError<InputError>([&] { ParseJsonFile(folder_.path()); }, {"cannot be read"});
}

TEST_F(JsonFileTest, HeaderNamesWhatShapedTheArtefact) {
  const auto b = Write("b.txt", "b");
  const auto a = Write("a.txt", "abc");
  WriteArtefact(file, "landmarks", {{{"yaw", 3}}, {b, a}, {}, "refine"}, kEmptyLandmarks);
  const json header = ReadArtefact(file, "landmarks").at("artefact");
  EXPECT_EQ(header.at("kind"), "landmarks");
  EXPECT_EQ(header.at("schema_version"), json({1, 12}));
  EXPECT_THAT(header.at("software").get<std::string>(), testing::StartsWith("soslam "));
  EXPECT_EQ(header.at("stage"), "refine");
  EXPECT_EQ(header.at("settings").at("yaw"), 3);
  EXPECT_EQ(header.at("inputs").at(0).at("file"), "a.txt");
  EXPECT_EQ(header.at("inputs").at(0).at("sha256"),  // FIPS 180-2, appendix B.1
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(header.at("inputs").at(1).at("file"), "b.txt");
}

TEST_F(JsonFileTest, NamesOfFilesNeedNotBeUtf8) {
  const std::filesystem::path input = Write("caf\xe9.txt", "bytes");
  WriteArtefact(file, "landmarks", {{{"labels", "\xe9"}}, {input}}, kEmptyLandmarks);
  const json header = ReadArtefact(file, "landmarks").at("artefact");
  EXPECT_EQ(header["inputs"][0]["file"], "caf\xef\xbf\xbd.txt");
  EXPECT_EQ(header["settings"]["labels"], "\xef\xbf\xbd");
}

TEST_F(JsonFileTest, HeadersThatAreNotOursAreRefused) {
  EXPECT_NO_THROW(ReadWithHeader(ArtefactHeader("landmarks", {})));
  EXPECT_NO_THROW(ReadWithHeader(HeaderOfVersion({1, 0})));
  for (const auto& [header, words] : std::vector<std::pair<json, std::string>>{
           {HeaderOfVersion({2, 0}),
            "has schema version [2, 0] of kind 'landmarks'; this software "
            "reads up to [1, 12]"},
           {HeaderOfVersion({1, 13}), "[1, 12]"},
           {HeaderOfVersion("1.0"), "schema_version is \"1.0\""},
           {HeaderOfVersion({1, -1}), "schema_version is [1,-1]"},
           {ArtefactHeader("map", {}), "kind is \"map\"; expected \"landmarks\""},
           {nullptr, "no artefact header"}}) {
    ExpectError<InputError>([&, &header = header] { ReadWithHeader(header); },
                            {"some.json: ", words});
  }
  ExpectError<InputError>([&] { ReadArtefact(Write("some.json", "[1]"), "landmarks"); },
                          {"no artefact header"});
}

TEST_F(JsonFileTest, AnOlderFileThatLacksAFieldIsSaidToBeOlder) {
  const json document = {{"artefact", HeaderOfVersion({1, 8})}};
  ExpectError<InputError>([&] { ReadArtefact(Write("some.json", document.dump()), "landmarks"); },
                          {"some.json: ", "has no field \"observations\"; expected one",
                           "schema version is [1,8]", "[1, 12]: run the stage"});
}

TEST_F(JsonFileTest, FindingsOfWhatIsNoArtefactAreRefused) {
  for (const json& document : {json(), json::array(), json("text")}) {
    ExpectError<InputError>([&] { ReadFindings(document); }, {"is no object"});
  }
  EXPECT_TRUE(ReadFindings(json::object()).empty());
}

TEST_F(JsonFileTest, WritingWhatTheSchemaForbidsIsOurBug) {
  EXPECT_THROW(WriteArtefact(file, "landmarks", {}, {{"objects", 3}}), std::logic_error);
  EXPECT_THROW(WriteArtefact(file, "no such kind", {}, json::object()), std::logic_error);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace soslam
