// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/parameters_by_name.hpp"

#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

std::map<std::string, ParameterAddress> addresses_by_name(const Chain& chain) {
  std::map<std::string, ParameterAddress> addresses;
  for (const ParameterSet& set : {all_parameters(chain, {}), setup_parameters(chain, {})})
    for (const Parameter& parameter : set.parameters) addresses.emplace(parameter.name, parameter.at);
  for (const ParameterAddress& at : non_geometric_addresses(chain)) addresses.emplace(name_of(chain, at), at);
  return addresses;
}

}  // namespace kinfer
