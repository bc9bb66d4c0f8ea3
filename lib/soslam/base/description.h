// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace soslam {

// Files are described once. A struct that is stored has, beside it,
//
//   template <typename Visitor>
//   void Describe(Visitor& visit, Plane& plane) {
//     visit.Field("normal", &plane.normal, "unit normal, away from the floor");
//     visit.Field("offset", &plane.offset, "metres");
//   }
//
// from which reading, writing and the JSON schema follow (artefact/described_json.h). Visitors have
//
//   Field(name, value, doc, limits)     a field that is always there; null for an empty optional
//   OrNull(name, value, doc, limits)    null where the value is that of a new one, as an empty text
//   OrAbsent(name, value, doc, limits)  absent where the value is that of a new one
//   OrDefault(name, value, default, doc, limits)
//                                       always written; files without it have the default
//   Unit(name, value, doc)              a vector or quaternion of norm 1
//   IsText(text, doc)                   true if a text stands for the whole struct
//   Item(value, doc, limits)            the next number or text of a list that stands for a struct
//   Id(name, index, &Sequence::objects, doc)
//                                       id of the item of sequence(), without which the index is
//                                       the id
//   Check(violation)                    what no limits express: violation() returns in words what
//                                       was found and expected, empty where all is right; called
//                                       once the fields above it are read
//   AfterReading(action)                called once the fields above it are read, for what a file
//                                       stores in another form
//   OfSequence(sequence)                this is what is described, so that ids are of it
//   FrameIdItem(index, doc)             the id of a frame as an item
//   sequence()                          the sequence that a file is of; null if unknown
//
// A doc says what a value is, with its unit where its name has none. Values may be truth values,
// numbers, texts, enumerations with a function NamesOf, vectors and matrices, structs, any JSON,
// and optionals, lists and maps of these.

// Limits of a number, of all numbers in a list, or of the length of a text.
struct Limits {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool excludes_min = false;
  int least_items = 0;  // of a list
};
inline constexpr Limits kNotNegative = {0.0};
inline constexpr Limits kPositive = {0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Limits kShare = {0.0, 1.0};
inline constexpr Limits kAtLeastOne = {1.0};
inline constexpr Limits kNotEmpty = {1.0};

// An enumeration whose values 0..n-1 have names by NamesOf(value).
template <typename Enum>
concept Named = requires(Enum value) {
  { NamesOf(value) } -> std::convertible_to<std::span<const char* const>>;
};

// The reason why a text is none of these, in words; empty if it is one.
std::string NotOneOf(const char* field, const std::string& text,
                     const std::vector<std::string>& known);

template <Named Enum>
const char* NameOf(Enum value) {
  return std::span<const char* const>(NamesOf(value))[static_cast<size_t>(value)];
}

}  // namespace soslam
