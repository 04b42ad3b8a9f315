// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/run_tables.hpp"

#include <fmt/format.h>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::app {

void RunTables::open(const Model& model, const std::vector<std::string>& goals) {
  const bool mcap = io::isMcap(options_.log);
  if (!options_.log.empty() && (mcap ? logEnd_.has_value() : !mcapEnd_.empty()))
    throw ModelError({options_.log.string(), 0}, "--log",
                     fmt::format("found {}, expected {} as the run began it", mcap ? "MCAP" : "CSV",
                                 mcap ? "CSV" : "MCAP"));
  if (mcap)
    mcap_.emplace(options_.log, model, goals, options_.logEvery, mcapEnd_);
  else if (!options_.log.empty())
    log_.emplace(options_.log, model, goals, options_.logEvery, logEnd_);
  if (!options_.contacts.empty()) contacts_.emplace(options_.contacts, model, contactsEnd_);
}

void RunTables::write(const io::StepRecord& row,
                      const std::vector<Snapshot::ContactForce>& touching) {
  if (!errors_.none()) return;
  if (log_) errors_.attempt([&] { log_->write(row); });
  if (mcap_) errors_.attempt([&] { mcap_->write(row, touching); });
  if (contacts_ && !row.isEnd) errors_.attempt([&] { contacts_->write(row.time, touching); });
}

void RunTables::close() {
  if (!errors_.none()) return;
  if (log_) errors_.attempt([&] { log_->close(); });
  if (mcap_) errors_.attempt([&] { mcap_->close(); });
  if (contacts_) errors_.attempt([&] { contacts_->close(); });
}

}  // namespace softgauss::app
