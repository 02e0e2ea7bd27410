// palpate: batch mechanical testing of virtual soft tissue.
#include "cli/program.h"

int main(int argc, char** argv) { return palpate::cli::program({argv + 1, argv + argc}); }
