// SPDX-License-Identifier: Apache-2.0

/// The smallest use of an installed softgauss.

#include "engine/model/model_builder.hpp"

int main() {
  const softgauss::ModelBuilder builder;
  return 0;
}
