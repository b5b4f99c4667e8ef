#pragma once

namespace thermovox {

/// The style sheet of the reports: A4 in print, one column on a phone.
extern const char* const kReportStyle;

}  // namespace thermovox
