// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/chain_dh_csv.hpp"

#include <fmt/format.h>

#include <tuple>

namespace kinfer {

std::string format_chain_dh_csv(const std::vector<DhRowEstimate>& rows) {
  std::string text = "segment,theta,d,a,alpha,variable,theta_sd,d_sd,a_sd,alpha_sd,beta,beta_sd\n";
  for (const DhRowEstimate& found : rows) {
    const auto& [row, sd] = std::tie(found.row, found.sd);
    text += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{},{:.3g},{:.3g},{:.3g},{:.3g},{:.9g},{:.3g}\n", found.segment,
                        row.theta, row.d, row.a, row.alpha, found.variable(), sd.theta, sd.d, sd.a, sd.alpha, row.beta,
                        sd.beta);
  }
  return text;
}

}  // namespace kinfer
