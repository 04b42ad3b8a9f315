// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scalar and array types of the engine. Everything is double precision and SI (m, kg, s, rad, N).

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace softgauss {

using Vector3 = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix3 = Eigen::Matrix3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;
using RowMajorMatrixX = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Quaternion = Eigen::Quaterniond;

template <class T>
using Ref = Eigen::Ref<T>;

}  // namespace softgauss
