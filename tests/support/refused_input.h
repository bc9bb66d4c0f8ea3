// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "support/stage_chain.h"

namespace soslam {

// Makes an input of the next stage bad.
using Spoil = std::function<void(const StageChain&)>;

// Replaces the first `from` of a file, which has to be there.
inline void Replace(const std::filesystem::path& path, const std::string& from,
                    const std::string& to) {
  std::string bytes = FileBytes(path);
  const size_t found = bytes.find(from);
  ASSERT_NE(found, std::string::npos) << path << " has no " << from;
  WriteBytes(path, bytes.replace(found, from.size(), to));
}

// Replaces a line, counted from 1, of a file of the dataset.
inline Spoil Line(const std::string& file, int number, const std::string& line) {
  return [=](const StageChain& chain) {
    std::string text = FileBytes(chain.Dataset(file));
    size_t begin = 0;
    for (int i = 1; i < number; ++i) begin = text.find('\n', begin) + 1;
    const size_t end = text.find('\n', begin);
    ASSERT_NE(end, std::string::npos) << file << " has no line " << number;
    WriteBytes(chain.Dataset(file), text.replace(begin, end - begin, line));
  };
}

inline Spoil DatasetText(const std::string& file, const std::string& from, const std::string& to) {
  return [=](const StageChain& chain) { Replace(chain.Dataset(file), from, to); };
}

inline Spoil ArtefactText(const std::string& file, const std::string& from, const std::string& to) {
  return [=](const StageChain& chain) { Replace(chain.Artefact(file), from, to); };
}

inline Spoil Content(const std::string& file, const std::string& content) {
  return [=](const StageChain& chain) { WriteBytes(chain.Dataset(file), content); };
}

inline void Truncate(const std::filesystem::path& path) {
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
}

// Does something to a file of the dataset, or to an artefact.
inline Spoil ToDataset(const std::string& file, void (*act)(const std::filesystem::path&)) {
  return [=](const StageChain& chain) { act(chain.Dataset(file)); };
}
inline Spoil ToArtefact(const std::string& file, void (*act)(const std::filesystem::path&)) {
  return [=](const StageChain& chain) { act(chain.Artefact(file)); };
}

// A row of the tables of bad inputs.
struct RefusedInput {
  std::string name;
  std::string stage;  // that meets it, after all stages ran on the sound dataset
  Spoil spoil;
  int exit_code;
  std::vector<std::string> words;  // of the error: the file, what was found
};

inline RefusedInput Refused(std::string name, std::string stage, Spoil spoil,
                            std::vector<std::string> words, int exit_code = 3) {
  return {std::move(name), std::move(stage), std::move(spoil), exit_code, std::move(words)};
}

inline void PrintTo(const RefusedInput& input, std::ostream* stream) { *stream << input.name; }

template <typename Case>
std::string CaseName(const testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

inline std::set<std::string> NamesIn(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

// One line that a terminal takes for text, and a person can read.
inline void ExpectOneLine(const std::string& errors) {
  constexpr size_t kMaxLength = 2500;
  EXPECT_LE(errors.size(), kMaxLength);
  ASSERT_FALSE(errors.empty());
  EXPECT_EQ(errors.back(), '\n');
  EXPECT_TRUE(std::all_of(errors.begin(), errors.end() - 1, [](unsigned char character) {
    return character >= 0x20 && character != 0x7F;
  })) << errors;
}

// Runs a row: its exit code, and one line that names it; what was written before stays as it was,
// and nothing but the record of the failure is left beside it.
inline void ExpectRefused(const RefusedInput& bad) {
  const StageChain& chain = StageChain::Finished();
  ASSERT_NO_FATAL_FAILURE(bad.spoil(chain));
  const std::filesystem::path output = chain.Artefact(StageChain::OutputOf(bad.stage));
  WriteBytes(output, "from before");
  std::set<std::string> names = NamesIn(output.parent_path());
  names.insert("run.json");

  const CommandResult result = chain.Run(bad.stage);
  EXPECT_EQ(result.exit_code, bad.exit_code);
  EXPECT_THAT(result.errors, testing::StartsWith("soslam-" + bad.stage + ": error: "));
  ExpectOneLine(result.errors);
  for (const std::string& word : bad.words) EXPECT_THAT(result.errors, testing::HasSubstr(word));
  EXPECT_EQ(FileBytes(output), "from before");
  EXPECT_EQ(NamesIn(output.parent_path()), names);
}

}  // namespace soslam
