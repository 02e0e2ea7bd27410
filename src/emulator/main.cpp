// palpate-emulator: emulates a test stand and a haptic arm.
#include "emulator/arguments.h"

int main(int argc, char** argv) { return emulator::program(argc, argv); }
