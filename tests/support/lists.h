// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <type_traits>
#include <vector>

namespace soslam {

// A field of each element of a list, or what a function makes of it.
template <typename List, typename Field>
auto Fields(const List& list, const Field& field) {
  using Value = std::invoke_result_t<Field, const typename List::value_type&>;
  std::vector<std::decay_t<Value>> values;
  for (const auto& element : list) values.push_back(std::invoke(field, element));
  return values;
}

// The only element of a list. Where it has none or more, that is a failure of the test.
template <typename List>
typename List::value_type Only(const List& list) {
  EXPECT_EQ(list.size(), 1u);
  return list.empty() ? typename List::value_type() : *list.begin();
}

}  // namespace soslam
