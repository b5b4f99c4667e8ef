#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace thermovox {

/// Reads one number that fills the whole text, whatever the locale: decimal or scientific, with an optional
/// sign ("+5" too), "inf" and "nan". nullopt for anything else, also beyond the range of a double.
[[nodiscard]] std::optional<double> parseNumber(std::string_view text);

/// Reads one whole number that fills the whole text; nullopt for anything else.
[[nodiscard]] std::optional<int> parseInteger(std::string_view text);

/// The shortest decimal text that reads back as the very same double, whatever the locale.
[[nodiscard]] std::string exactText(double number);

/// The text without blanks, tabs and carriage returns at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Whether the text is well-formed UTF-8 (Unicode 15, table 3-7) without control characters.
[[nodiscard]] bool isPrintableUtf8(std::string_view text);

/// The text in quotes for a message: shortened to 40 characters, unprintable bytes as '?'.
[[nodiscard]] std::string inQuotes(std::string_view text);

}  // namespace thermovox
