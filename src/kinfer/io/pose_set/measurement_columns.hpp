// SPDX-License-Identifier: Apache-2.0
// Columns of one kind of measurement in a pose-set file. Each kind of measurement_lists has a file that defines them.
#pragma once

#include "kinfer/io/pose_set/column_map.hpp"
#include "kinfer/io/pose_set/pose_columns.hpp"
#include "kinfer/io/pose_set/pose_sheet.hpp"
#include "kinfer/io/pose_set/required_content.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// What the readers of all kinds share.
struct ReadContext {
  const Chain& chain;
  const ColumnMap& map;
  RequiredContent required;
};

struct MeasurementColumns {
  void (*read)(PoseColumns&, const ReadContext&, PoseSet&);  ///< null: read together with another kind
  void (*write)(PoseSheet&, const PoseSet&);
};
/// Of the kind M; specialised in the file of each instrument.
template <class M>
MeasurementColumns measurement_columns();

/// Reads the names in column `kind` into the measurements that refer to a fixture of that kind.
template <class M>
void read_fixture_contacts(PoseColumns& columns, const ReadContext&, PoseSet& set) {
  auto named = columns.name_indices(M::traits.fixture);
  if (!named) return;
  for (std::size_t row = 0; row < columns.rows(); ++row)
    if (named->index[row] >= 0) list_of<M>(set).push_back({static_cast<int>(row), named->index[row]});
  *find_fixture_names(set, M::traits.fixture) = std::move(named->names);
}

template <class M>
void write_fixture_names(PoseSheet& sheet, const PoseSet& set) {
  if (list_of<M>(set).empty()) return;
  const std::size_t column = sheet.column(std::string(M::traits.fixture));
  for (const M& measured : list_of<M>(set))
    sheet.set(column, measured.row, (*find_fixture_names(set, M::traits.fixture))[measured.*M::fixture_index]);
}

}  // namespace kinfer
