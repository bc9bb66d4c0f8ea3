// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "soslam/base/options.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"
#include "soslam/priors/furniture_catalogue.h"

namespace soslam {

// 1.4826 times the median absolute deviation from the median: the standard deviation of normal
// values, robust to less than half of outliers (Rousseeuw and Croux 1993). 0 for a single value.
double RobustSigma(const std::vector<double>& values);

// Belief about a normal quantity whose mean and spread are both learned. The weights are in units
// of observed values.
struct NormalBelief {
  double mean = 0.0;
  double mean_weight = 0.0;
  double sigma = 1.0;
  double sigma_weight = 1.0;
};

// The normal-inverse-chi-squared update (Gelman et al., Bayesian Data Analysis, 3rd edition, eq.
// 3.3), with the median and the robust sigma, at least `min_sigma`, in place of mean and standard
// deviation.
NormalBelief Update(const NormalBelief& prior, const std::vector<double>& values, double min_sigma);

// The standard deviation of a future value: the belief's own spread and the uncertainty of its
// mean. (The scale of the predictive Student distribution.)
double PredictiveSigma(const NormalBelief& belief);

// The correlation of values in pairs; each is measured in robust sigmas from the median of its kind
// and clipped at 2.5. None for fewer than three pairs, or if values of a kind do not vary.
std::optional<double> RobustCorrelation(const std::vector<double>& firsts,
                                        const std::vector<double>& seconds);

// Treatment of rows that the base table has.
enum class BaseRows {
  kKeep,    // ratio, spread and shape stay; height and correlation are learned if they are missing
  kUpdate,  // they serve as prior and are updated with the data
};
inline constexpr std::array kBaseRowsNames = {"keep", "update"};

// Options of soslam-learn-priors.
struct LearnPriorsOptions {
  BaseRows base_rows = BaseRows::kUpdate;
  double min_log_sigma = 0.1;
  double spread_weight = 4.0;
  double correlation_weight = 8.0;
  int min_views = 10;
  bool edge_bias = false;
  double no_bias_weight = 2.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Table");
    visit.Choice("base_rows", &base_rows, kBaseRowsNames,
                 "keep: ratios, spreads and shapes of the base table stay, what it lacks is "
                 "learned; update: its ratios and heights count as so many objects as they were "
                 "learned from, at least one, its correlations as correlation_weight, its shapes "
                 "where none is learned");
    visit.Group("Ratios, heights and shapes");
    visit.Real("min_log_sigma", &min_log_sigma, {1e-3, 1.0},
               "Robust spread of a label's logarithms is taken to be at least this");
    visit.Real("spread_weight", &spread_weight, {0.1, 1e3},
               "What the spread of all labels (or of the base table's row) counts as, in objects");
    visit.Real("correlation_weight", &correlation_weight, {0.1, 1e3},
               "What the correlation over all labels counts as, in objects");
    visit.Integer("min_views", &min_views, {1, 1000000},
                  "Boxes that an object needs for its shape exponents to be learned");
    visit.Group("Edges of boxes");
    visit.Flag("edge_bias", &edge_bias,
               "Learn the bias of box edges by label and side from the sequences: the table "
               "is then one for the detector that their boxes are of");
    visit.Real("no_bias_weight", &no_bias_weight, {0.0, 1e3}, "What no bias counts as, in objects");
  }
};

// The data of one source for a label: half axes along x (front), y and z (up) of the upright
// object, in metres, one per object; shape exponents of the objects whose boxes determine it.
struct LabelFacts {
  std::vector<Eigen::Vector3d> half_axes;
  std::vector<ShapeExponents> shape_exponents;
};
struct PriorSource {
  std::string name;                         // as tables cite it
  std::map<std::string, LabelFacts> facts;  // by label
};

// The ground truth of a sequence; the table supplies how objects are mounted.
PriorSource SourceOfSequence(const Sequence& sequence, const SemanticTable& table, int min_views);
// The models of a catalogue that have a label.
PriorSource SourceOfCatalogue(const std::string& name, const std::vector<CatalogueModel>& models,
                              const CatalogueNames& names);

// The models without those that equal, to the millimetre, an object of a sequence with ground
// truth; the table supplies how objects are mounted.
std::vector<CatalogueModel> ExcludeObjects(const Sequence& sequence, const SemanticTable& table,
                                           std::vector<CatalogueModel> models);

// The base table, updated row by row with the data of the sources; labels that it lacks become
// rows. Method: docs/priors.md. Throws InputError as LookUpTable.
SemanticRows LearnPriors(const SemanticRows& base, const std::vector<PriorSource>& sources,
                         const LearnPriorsOptions& options);

// The error of a label's prior for the true ratio of an object.
struct PriorError {
  std::string label;
  Eigen::Vector2d log_error;   // log of true / predicted (a / c, b / c)
  Eigen::Vector2d normalised;  // the same, divided by the prior's sigmas
};
// Errors for the objects with ground truth and a row (or default) in the table.
std::vector<PriorError> PriorErrors(const Sequence& sequence, const SemanticTable& table);

// The exponents for which the true pose and size of an object fit its boxes best, for each object
// with ground truth and at least `min_views` boxes that show it wholly in front of the camera, by
// object index.
std::map<int, ShapeExponents> LearnShapeExponents(const Sequence& sequence, int min_views);

// Learns the bias of a detector's box edges for each row of a table that has objects with ground
// truth in the sequences. Edges that are not one-sided are compared with the outline of the object
// at its true pose and size, with the row's shape. The errors of an object's boxes are alike: it
// counts once, by their median. `no_bias_weight` objects without bias are added to those of each
// row. Method: docs/priors.md.
void LearnEdgeBias(const std::vector<Sequence>& sequences, double no_bias_weight,
                   SemanticRows* rows);

}  // namespace soslam
