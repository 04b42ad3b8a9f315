// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/broadphase.hpp"

#include <algorithm>

namespace softgauss::collision::detail {

Broadphase::Broadphase(std::vector<double> radii) : radii_(std::move(radii)) {
  sorted_.reserve(radii_.size());
}

void Broadphase::findNear(const std::vector<Vector3>& centres, double growth,
                          std::vector<std::pair<int, int>>& near) {
  Vector3 sum = Vector3::Zero(), squares = Vector3::Zero();
  for (const Vector3& c : centres) {
    sum += c;
    squares += c.cwiseProduct(c);
  }
  int axis = 0;
  const double count = static_cast<double>(centres.size());
  (squares - sum.cwiseProduct(sum) / count).maxCoeff(&axis);

  sorted_.clear();
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const double radius = radii_[i] + growth;
    sorted_.push_back({centres[i][axis] - radius, radius, centres[i], static_cast<int>(i)});
  }
  // A centre that is not finite goes to the end, where it is near nothing.
  std::sort(sorted_.begin(), sorted_.end(), [](const Sphere& a, const Sphere& b) {
    return a.begin < b.begin || (b.begin != b.begin && a.begin == a.begin);
  });

  for (std::size_t i = 0; i < sorted_.size(); ++i) {
    const Sphere& a = sorted_[i];
    const double end = a.begin + 2.0 * a.radius;
    for (std::size_t j = i + 1; j < sorted_.size() && sorted_[j].begin < end; ++j) {
      const Sphere& b = sorted_[j];
      const double reach = a.radius + b.radius;
      if ((b.centre - a.centre).squaredNorm() < reach * reach)
        near.push_back(std::minmax({a.index, b.index}));
    }
  }
}

}  // namespace softgauss::collision::detail
