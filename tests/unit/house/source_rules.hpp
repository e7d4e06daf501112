// The rules of the house that a compiler does not hold: who may include whom, which room may use which library, what is
// called alike, where threads start and clocks are read, how long a file may be, and that nothing is left unfinished.
// Pure; a source is a path and a text, so that the rules can be tried on sources that do not exist.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace talus::house {

struct Source {
  std::string path;  ///< from the root of the project, with '/'
  std::string text;
};

struct Fault {
  std::string path;
  std::size_t line = 0;  ///< from 1; 0 when the whole file is meant
  std::string message;
};

/// The room a file is in: its first two folders for core, server and client_sample, else its first one.
std::string room_of(std::string_view path);

/// Our own headers: a room includes itself and the rooms below it; nobody includes tests.
std::vector<Fault> include_order_faults(const Source& source);
/// Libraries and system headers: each only in the rooms that own it.
std::vector<Fault> library_faults(const Source& source);
/// Libraries that cost seconds wherever they are included: never in a header, and in few sources.
std::vector<Fault> heavy_library_faults(const std::vector<Source>& sources);
/// A type outside anonymous namespaces has one definition: a second one of its name makes a program whose behaviour is
/// not defined, and no compiler that sees one source at a time says so.
std::vector<Fault> one_definition_faults(const std::vector<Source>& sources);
/// Threads, clocks, length and unfinished words.
std::vector<Fault> text_faults(const Source& source);

}  // namespace talus::house
