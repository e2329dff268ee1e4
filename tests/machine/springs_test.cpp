#include <doctest/doctest.h>

#include <Eigen/LU>
#include <string>

#include "machine_texts.hpp"

using namespace counterflex;

namespace {

Spring spring(const std::string& body) {
  return part<Spring>(machine_of("{ spring = \"s\" }", "[springs.s]\n" + body + "\n").chains.at(0), 0);
}

std::string text_of(const Matrix6& A) {
  std::string text = "[";
  for (int i = 0; i < 6; ++i) {
    text += "[";
    for (int j = 0; j < 6; ++j) text += std::to_string(A(i, j)) + ",";
    text += "],";
  }
  return text + "]";
}

Matrix6 some_stiffness() {
  Matrix6 K = Vector6(4e6, 9e6, 1e6, 400, 900, 100).asDiagonal();
  K(1, 5) = K(5, 1) = 1.5e4;
  K(2, 4) = K(4, 2) = -2e4;
  return K;
}

const std::string beam_sizes = "length_mm = 500, EA_N = 4e7, GJ_Nm2 = 3000, EIy_Nm2 = 5000, EIz_Nm2 = 8000";

Matrix6 beam_compliance(const std::string& axis) {
  return spring("beam = { " + beam_sizes + axis + " }").K.inverse();
}

}  // namespace

TEST_CASE("stiffness_si is used unchanged") {
  CHECK((spring("stiffness_si = " + text_of(some_stiffness())).K - some_stiffness()).norm() == 0);
}

TEST_CASE("compliance_si is inverted") {
  const Matrix6 C = some_stiffness();  // a matrix is a matrix
  CHECK((spring("compliance_si = " + text_of(C)).K * C - Matrix6::Identity()).norm() < 1e-9);
}

TEST_CASE("an asymmetry within 1e-6 of the entry is averaged away, one beyond is refused") {
  Matrix6 K = some_stiffness();
  K(1, 5) *= 1 + 0.5e-6;
  const Matrix6 read = spring("stiffness_si = " + text_of(K)).K;
  CHECK(read(1, 5) == read(5, 1));
  CHECK(read(1, 5) == doctest::Approx(1.5e4).epsilon(1e-6));
  K(1, 5) = 1.5e4 * (1 + 2e-6);
  CHECK_THROWS(spring("stiffness_si = " + text_of(K)));
}

TEST_CASE("noise that is negligible beside the diagonal is not an asymmetry") {
  Matrix6 K = some_stiffness();
  K(0, 1) = 1e-3;
  K(1, 0) = -1e-3;
  CHECK(spring("stiffness_si = " + text_of(K)).K(0, 1) == 0);
}

TEST_CASE("a stiffness may be semidefinite, a compliance may not") {
  Matrix6 K = some_stiffness();
  K(0, 0) = 0;
  CHECK(spring("stiffness_si = " + text_of(K)).K(0, 0) == 0);
  CHECK_THROWS(spring("compliance_si = " + text_of(K)));
  Matrix6 rank_one = Vector6(1, 2, 3, 4, 5, 6) * Vector6(1, 2, 3, 4, 5, 6).transpose();
  CHECK((spring("stiffness_si = " + text_of(rank_one)).K - rank_one).norm() == 0);
  CHECK_THROWS(spring("compliance_si = " + text_of(rank_one)));
}

TEST_CASE("a matrix that is indefinite only as a whole is refused") {
  Matrix6 K = Matrix6::Identity();
  K(3, 4) = K(4, 3) = K(3, 5) = K(5, 3) = K(4, 5) = K(5, 4) = -0.51;
  CHECK_THROWS(spring("stiffness_si = " + text_of(K)));
  K(3, 4) = K(4, 3) = K(3, 5) = K(5, 3) = K(4, 5) = K(5, 4) = -0.5;
  CHECK_NOTHROW(spring("stiffness_si = " + text_of(K)));
}

TEST_CASE("six numbers are a diagonal") {
  const Vector6 k(1e6, 2e6, 0, 4, 5, 6);
  CHECK(spring("stiffness_diag_si = [1e6, 2e6, 0, 4, 5, 6]").K == Matrix6(k.asDiagonal()));
  const Matrix6 K = spring("compliance_diag_si = [1e-6, 2e-6, 4e-6, 1, 2, 4]").K;
  CHECK((K.diagonal() - Vector6(1e6, 5e5, 2.5e5, 1, 0.5, 0.25)).norm() < 1e-9);
}

TEST_CASE("a beam has the tip compliance of a cantilever along x") {
  enum { x, y, z, rx, ry, rz };
  const Matrix6 C = beam_compliance("");
  CHECK(C(x, x) == doctest::Approx(0.5 / 4e7));
  CHECK(C(rx, rx) == doctest::Approx(0.5 / 3000));
  CHECK(C(y, y) == doctest::Approx(0.125 / (3 * 8000.0)));
  CHECK(C(rz, rz) == doctest::Approx(0.5 / 8000));
  CHECK(C(y, rz) == doctest::Approx(0.25 / (2 * 8000.0)));
  CHECK(C(z, z) == doctest::Approx(0.125 / (3 * 5000.0)));
  CHECK(C(ry, ry) == doctest::Approx(0.5 / 5000));
  CHECK(C(z, ry) == doctest::Approx(-0.25 / (2 * 5000.0)));
  CHECK(beam_compliance(", axis = \"x\"") == C);
}

TEST_CASE("a beam along y bends about z with EIz, and by the turned EIy about x") {
  enum { x, y, z, rx, ry, rz };
  const Matrix6 C = beam_compliance(", axis = \"y\"");
  CHECK(C(y, y) == doctest::Approx(0.5 / 4e7));
  CHECK(C(ry, ry) == doctest::Approx(0.5 / 3000));
  CHECK(C(x, rz) == doctest::Approx(-0.25 / (2 * 8000.0)));  // a push along x turns the tip against z
  CHECK(C(z, rx) == doctest::Approx(0.25 / (2 * 5000.0)));
}

TEST_CASE("a beam along z bends about y with EIy, and by the turned EIz about x") {
  enum { x, y, z, rx, ry, rz };
  const Matrix6 C = beam_compliance(", axis = \"z\"");
  CHECK(C(z, z) == doctest::Approx(0.5 / 4e7));
  CHECK(C(rz, rz) == doctest::Approx(0.5 / 3000));
  CHECK(C(x, ry) == doctest::Approx(0.25 / (2 * 5000.0)));
  CHECK(C(y, rx) == doctest::Approx(-0.25 / (2 * 8000.0)));
}

TEST_CASE("a spring's preload is its rest value, and \"home\" means zero") {
  const std::string body = "stiffness_diag_si = [1, 1, 1, 1, 1, 1]\n";
  CHECK(spring(body).theta_0.isZero(0));
  CHECK(spring(body + "preload = \"home\"").theta_0.isZero(0));
  CHECK(spring(body + "preload_si = [1e-3, 0, 0, 0, 0, 2e-3]").theta_0 == Vector6(1e-3, 0, 0, 0, 0, 2e-3));
}
