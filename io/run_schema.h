#pragma once

#include <string>

#include "io/run_codec.h"
#include "io/run_database.h"

namespace vantage {

/// Creates the tables of a run file. For `sqlite3` users; the exact record comes from `product`.
///   run          key, value: the header, stop_reason
///   run_product  name, data: header, truth and end of the run, compressed
///   step         one row for each finished step: decision, counts, metrics, timings
///   closing      the scan at the last view: metrics
///   scan         camera poses of each step's scan
///   segment      segments of each step with all saliency terms
///   product      everything else, compressed, by step, stage and name
///   chosen       (view) the chosen views
void createSchema(Database& database);

/// \throws InputError, through the database, unless the file is a run of a version that this program reads.
void requireRun(Database& database);

/// Rows of a header or a record in the tables that people query.
void insertHeader(Database& database, const RunHeader& header);
void insertStep(Database& database, const StepRecord& record, int step);
void insertClosing(Database& database, const StepRecord& record, int step);

/// Fills in the columns of a step that were not known when it was stored.
void updateRealised(Database& database, const Realised& realised, int step);

/// What the tables tell of the steps; columns that an old run lacks are empty.
std::vector<StepSummary> readSummaries(Database& database);

/// Adds or replaces a row of `run`.
void putRunValue(Database& database, const std::string& key, const std::string& value);

/// Adds or replaces a product.
void putProduct(Database& database, const StoredProduct& product, int step);
void putRunProduct(Database& database, const StoredProduct& product);

}  // namespace vantage
