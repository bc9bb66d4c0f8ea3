// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/frame_lookup.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

const FrameLookup kLookup(
    {{1.0, "rgb/12.50.png"}, {2.0, "rgb/12.51.png"}, {3.0, "a/0.png"}, {4.0, "b/0.png"}});

TEST(FrameLookupTest, RowsAreThemselves) {
  EXPECT_EQ(kLookup.Find(0, ""), 0);
  EXPECT_EQ(kLookup.Find(3, ""), 3);
  EXPECT_EQ(kLookup.Find(4, ""), std::nullopt);
  EXPECT_EQ(kLookup.Find(-1, ""), std::nullopt);
}

TEST(FrameLookupTest, NamesWithOrWithoutFolderAndExtension) {
  for (const char* name : {"rgb/12.51.png", "12.51.png", "12.51", "elsewhere/12.51.png"}) {
    EXPECT_EQ(kLookup.Find(name, ""), 1) << name;
  }
  EXPECT_EQ(kLookup.Find("12.52.png", ""), std::nullopt);
  EXPECT_EQ(kLookup.Find("12", ""), std::nullopt);
}

TEST(FrameLookupTest, FolderSettlesEqualNames) {
  EXPECT_EQ(kLookup.Find("b/0.png", ""), 3);
  ExpectError<InputError>([] { kLookup.Find("0.png", "boxes.json#/4"); },
                          {"boxes.json#/4", "'0.png'", "2, 3"});
}

}  // namespace
}  // namespace soslam
