// The program `tureen`.
#include "cli/program.hpp"

int main(int argc, char** argv) { return tureen::cli::run_program(argc, argv); }
