#pragma once

namespace CLI {
class App;
}

namespace thermovox {

// One verb, one file: parse, one library call, one report.
void addSimulate(CLI::App& app);
void addLocate(CLI::App& app);
void addMap(CLI::App& app);
void addMerge(CLI::App& app);
void addHotspots(CLI::App& app);
void addDiff(CLI::App& app);
void addReport(CLI::App& app);
void addExport(CLI::App& app);
void addCalibrate(CLI::App& app);
void addImage(CLI::App& app);
void addInfo(CLI::App& app);
void addOverlay(CLI::App& app);

}  // namespace thermovox
