#include "kinfer/io/chain_dh_csv.hpp"

#include <fmt/format.h>

namespace kinfer {

std::string chain_dh_csv(const std::vector<FoundDhRow>& rows) {
  std::string text = "segment,theta,d,a,alpha,variable,theta_sd,d_sd,a_sd,alpha_sd,beta,beta_sd\n";
  for (const auto& [segment, row, sd, variable, alpha_variable] : rows)
    text +=
        fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{},{:.3g},{:.3g},{:.3g},{:.3g},{:.9g},{:.3g}\n", segment, row.theta,
                    row.d, row.a, row.alpha, variable, sd.theta, sd.d, sd.a, sd.alpha, row.beta, sd.beta);
  return text;
}

}  // namespace kinfer
