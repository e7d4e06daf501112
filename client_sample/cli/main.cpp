#include "client_sample/cli/arguments.hpp"

int main(int argc, char** argv) {
  return talus::cli::run(argc, argv);
}
