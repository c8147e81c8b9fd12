// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/files/chain_dh_csv.hpp"

#include <fmt/format.h>

#include <tuple>

#include "kinfer/evidence/identification/unobservable_limit.hpp"
#include "kinfer/io/text/csv_text.hpp"

namespace kinfer {

namespace {

/// Value and standard deviation as cells; nan where the recording does not determine the number.
struct DhCells {
  std::string value, sd;
};

DhCells dh_cells(double value, double sd) {
  if (!(sd < unobservable_sd)) return {"nan", "nan"};
  return {fmt::format("{:.9g}", value), fmt::format("{:.3g}", sd)};
}

}  // namespace

std::string format_chain_dh_csv(const std::vector<DhRowEstimate>& rows) {
  std::string text = "segment,theta,d,a,alpha,variable,theta_sd,d_sd,a_sd,alpha_sd,beta,beta_sd\n";
  for (const DhRowEstimate& found : rows) {
    const auto& [row, sd] = std::tie(found.row, found.sd);
    const DhCells theta = dh_cells(row.theta, sd.theta), d = dh_cells(row.d, sd.d), a = dh_cells(row.a, sd.a),
                  alpha = dh_cells(row.alpha, sd.alpha), beta = dh_cells(row.beta, sd.beta);
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_cell(found.segment), theta.value, d.value, a.value,
                        alpha.value, csv_cell(found.variable()), theta.sd, d.sd, a.sd, alpha.sd, beta.value, beta.sd);
  }
  return text;
}

}  // namespace kinfer
