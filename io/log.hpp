// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The log of a run: comma-separated values, a header, then one row a step.
///
/// Columns: time_s; q:, v:, a:, u: of every joint [rad, m, N m, N and rates]; a floating joint as
/// `q:<joint>.x` .y .z .qw .qx .qy .qz and v:, `a:<joint>.vx` .vy .vz .wx .wy .wz, without u:, or
/// `q:<joint>(floating).x` … where a planar joint of that name has the others; then
/// contacts, constraints, iterations, dual_updates, physics_violation, gdd_violation, stationarity,
/// forward_us, gdd_us, step_us, energy_J, max_penetration_m; then `error:<goal> [unit]` of every
/// goal; com.x .y .z, cop.x .y .z [m], momentum.x .y .z [kg m/s], angular_momentum.x .y .z [kg
/// m²/s] about the centre of mass; and `f:<link>.x` .y .z of every link that moves and can touch:
/// the sum of the contact forces on it [N]. All in world axes.
///
/// A field is empty where there is no value: in the last row, the state at the end, all that a step
/// gives; the centre of pressure where the world carries nothing; a goal that asks for nothing.
/// Numbers are the shortest that read back bit for bit (at most 17 significant digits). A joint
/// whose name holds a comma, a quote or a line break is quoted as RFC 4180 has it.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/io/contact_links.hpp"

namespace softgauss::io {

namespace detail {
class RowFile;
}

/// One row: the state at `time` and what was computed from it.
struct StepRecord {
  double time = 0.0;  ///< [s]
  VectorX q;          ///< (nq)
  VectorX v;          ///< (nv)
  VectorX a;          ///< (nv) continuous-time acceleration
  VectorX u;          ///< (nv) control as applied, 0 where a dof has none [N m or N]
  int contacts = 0;
  int constraints = 0;            ///< rows
  int iterations = 0;             ///< of the GDD solver, or of the forward solve without goals
  int dualUpdates = 0;            ///< of the GDD solve
  double physicsViolation = 0.0;  ///< largest |g(q,v,a) − (u,0)| [N m or N]
  double gddViolation = 0.0;      ///< the same at the GDD solver's own acceleration
  double stationarity = 0.0;      ///< certificate of the GDD solver
  double realised = 0.0;          ///< StepStats::realised; not in the log
  double forwardUs = 0.0;         ///< time of the forward step [µs]
  double gddUs = 0.0;             ///< time of the GDD solve [µs]
  double stepUs = 0.0;            ///< time of the whole step [µs]
  double energy = 0.0;            ///< kinetic and potential [J]
  double kineticEnergy = 0.0;     ///< the kinetic part [J]; not logged
  double maxPenetration = 0.0;    ///< [m], ≥ 0
  VectorX goalErrors;             ///< one a goal of the log, in its unit; NaN where it has none
  Vector3 centerOfMass = Vector3::Zero();     ///< of all that moves [m]
  std::optional<Vector3> centerOfPressure;    ///< where the world carries something [m]
  Vector3 momentum = Vector3::Zero();         ///< of all that moves [kg m/s]
  Vector3 angularMomentum = Vector3::Zero();  ///< about the centre of mass [kg m²/s]
  VectorX linkForces;  ///< ContactLinks::forces() [N]; empty: not known, zero where nothing touches
  bool isEnd = false;  ///< the state at the end, from which no step was taken
};

/// What a record tells of the whole at `kinematics`: centre of mass and momentum.
void measureWhole(const Model& model, const Kinematics& kinematics, StepRecord& record);

/// What columns call the joint of a body; of a floating one, so that its parts have names of their
/// own.
std::string columnName(const Model& model, int body);

/// Names of the columns, unquoted, in order. `goals` are those of the goals' errors, units
/// included.
std::vector<std::string> logColumns(const Model& model, const std::vector<std::string>& goals = {});

/// How far a table was written when a run was saved: it goes on from there.
struct TableEnd {
  std::int64_t bytes = 0;  ///< −1: of no file
  std::int64_t seen = 0;   ///< records, written or not

  template <class Archive>
  void archive(Archive& a) {
    a(bytes, seen);
  }
};

/// Writes a log. Rows are buffered; what was written is on disk after flush(), close() or the end
/// of the writer's life.
class LogWriter {
 public:
  /// Every `every`-th record is written, and the last. "-" is standard output. `after`: end() of
  /// the earlier process whose rows these follow; later ones are cut off. Throws ModelError if the
  /// file cannot be made, or is not what was written then.
  LogWriter(const std::filesystem::path& file, const Model& model,
            const std::vector<std::string>& goals = {}, long every = 1,
            const std::optional<TableEnd>& after = {});
  ~LogWriter();
  LogWriter(LogWriter&&) noexcept;
  LogWriter& operator=(LogWriter&&) = delete;

  /// These throw std::runtime_error if the disk is full or gone.
  void write(const StepRecord& record);
  void flush();
  void close();
  TableEnd end();  ///< flushes

 private:
  void writeStep(const StepRecord& record);

  std::unique_ptr<detail::RowFile> rows_;
  std::vector<int> controls_;  ///< dofs of scalar joints
  Eigen::Index nq_, nv_, goals_, forces_;
  std::int64_t every_, seen_ = 0;
};

}  // namespace softgauss::io
