#pragma once
/// Vectors, poses and optional values as bytes.
#include <optional>

#include "counterflex/files/bytes.hpp"
#include "counterflex/geometry/pose.hpp"

namespace counterflex {

template <typename Derived>
void put_vector(const Eigen::DenseBase<Derived>& vector, std::string& bytes) {
  for (Eigen::Index c = 0; c < vector.cols(); ++c)
    for (Eigen::Index r = 0; r < vector.rows(); ++r) put(static_cast<double>(vector.derived()(r, c)), bytes);
}

template <int size>
Eigen::Matrix<double, size, 1> get_vector(BytesIn& bytes) {
  Eigen::Matrix<double, size, 1> vector;
  for (double& x : vector) x = bytes.get<double>();
  return vector;
}

inline void put_pose(const Pose& pose, std::string& bytes) {
  put_vector(pose.R, bytes);
  put_vector(pose.p, bytes);
}

template <PlainValue T>
void put_optional(const std::optional<T>& value, std::string& bytes) {
  put(value.has_value(), bytes);
  put(value.value_or(T{}), bytes);
}

template <PlainValue T>
std::optional<T> get_optional(BytesIn& bytes) {
  const bool has = bytes.get<bool>();
  const T value = bytes.get<T>();
  return has ? std::optional(value) : std::nullopt;
}

}  // namespace counterflex
