// palpate-emulator: a test stand and a haptic arm that are not there.
#include "emulator/arguments.h"

int main(int argc, char** argv) { return emulator::program(argc, argv); }
