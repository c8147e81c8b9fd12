// SPDX-License-Identifier: Apache-2.0
// evidence.json of `identify`, as values: all that the report shows. SI throughout; numbers for drawings are rounded.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinfer/evidence/facts/advice.hpp"
#include "kinfer/evidence/facts/records.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/kinematics/chain_view.hpp"

namespace kinfer {

struct UnobservableRecord {
  Unobservable unobservable{};
  std::string what{}, how{};  ///< the quantity, and the measurement that would determine it
};

/// Why a joint is not simply used, with its sentence.
struct JointDoubtRecord {
  JointDoubt doubt{};
  std::string sentence{};
};

/// A joint, its verdict, and what the recording does not determine of it.
struct JointRecord {
  JointEstimate estimate{};                        ///< without trajectory and unobservable quantities
  std::vector<std::string> sentences{};            ///< on the unobservable quantities, with remedies
  std::vector<UnobservableRecord> unobservable{};  ///< empty in files of earlier versions
  JointUsability usability = JointUsability::use;  ///< like the next two
  std::vector<JointDoubtRecord> doubts{};
  JointConnection connection{};
};

/// Correction of a sensor's clock.
struct ClockRecord {
  std::string sensor{};
  double offset = 0.0, offset_sd = 0.0;  ///< [s]
  double drift = 0.0, drift_sd = 0.0;    ///< [ppm]
};

/// Cost of the found chain on one segment's fitted rows.
struct SegmentFitRecord {
  LinkFit fitted{};
  std::string segment{};
  int rows = 0;
};

struct FitRecord {
  std::vector<SegmentFitRecord> fitted{};
  std::vector<std::pair<std::string, LinkFit>> holdout{};  ///< by segment
};

/// A leaf of a searched tree, without beta and standard deviations.
struct SearchRow {
  DhRowEstimate row{};
};

struct SegmentSearchRecord {
  std::string segment{};
  std::int64_t evaluations = 0;
  std::optional<LinkFit> written_fitted{}, written_holdout{};  ///< of the joint that is written; see LinkEvidence
  std::vector<SearchRow> found{}, merged{};
};

struct StructureSearchRecord {
  LinkSearchMethod method = LinkSearchMethod::memetic;
  std::int64_t evaluations = 0;  ///< of all segments
  int generations = 0;
  std::vector<std::vector<double>> best{}, median{};  ///< cost by generation, one list per segment
  std::vector<SegmentSearchRecord> segments{};
  bool is_start = false;  ///< of the fit
};

FitRecord fit_record(const std::vector<LinkEvidence>& searches);
StructureSearchRecord structure_search_record(const Identification& identification);

/// A change of the machine with its sentence.
struct ChainChangeRecord {
  ChainChange change{};
  std::string sentence{};
};

/// What changed on the machine since the identification whose chain was updated.
struct ChainUpdateRecord {
  std::string sentence{};
  std::vector<ChainChangeRecord> changes{};  ///< most certain first
  std::vector<ChainPartComparison> parts{};
  double squared_distance = 0.0;  ///< like the next two, as in ChainUpdate
  int freedom = 0;
  bool is_other_machine = false;
};

struct IdentificationEvidence {
  VerdictRecord verdict{};
  std::vector<FindingRecord> findings{};
  std::vector<std::string> notes{};
  std::string root{};
  std::vector<JointRecord> joints{};  ///< parents before children
  std::vector<LoopEstimate> loops{};  ///< joints that close kinematic loops
  std::vector<LinkEstimate> links{};
  std::vector<DhRowEstimate> dh{};
  ChainView chain{};
  std::vector<Advice> next{};
  std::vector<PointEstimate> places{};
  std::vector<ClockRecord> clocks{};
  std::vector<JointForecast> forecast{};
  OrderEvidence order{};
  FitRecord fit{};
  StructureSearchRecord search{};
  MotionEvidence motion{};
  std::optional<ChainUpdateRecord> update{};  ///< of `identify --update`
  ProvenanceRecord provenance{};
};

}  // namespace kinfer
