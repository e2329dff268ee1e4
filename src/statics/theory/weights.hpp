#pragma once
/// The weights of a series' masses: how they move with its columns, and how a branch feels that its start
/// frame turns. EQUATIONS.md, section 10.
#include "statics/theory/series.hpp"

namespace counterflex {

/// Room for the masses of `series`.
void make_mass_work(const Series& series, SeriesWork& work);

/// Fills `work.masses` from placed columns and evaluated branches; g_x_w apart.
void carry_masses(const Series& series, const SeriesState& state, SeriesWork& work);

/// Adds the weights to S: V_j . (g x w_k) for columns k upstream of j.
void add_second_moments(const Vector3& g, SeriesWork& work);

/// Begins the lean of a branch: how its own gradient turns with its start frame. Zero without Hessians.
void lean(const Vector3& g, Hessians hessians, SeriesWork& work);

/// Adds what the turning of a group's start frame does to a condensed branch that leans, and what the
/// branch's weights do to that frame, to the rows and columns of the series before the group (and to its own
/// lean, if it has one).
void enter_lean(const Series& series, const Part& group, const SeriesWork& branch, SeriesWork& work);

}  // namespace counterflex
