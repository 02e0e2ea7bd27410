# Writes a .cpp that holds a text file as a string.  -DSOURCE=... -DTARGET=...
file(READ ${SOURCE} text)
string(LENGTH "${text}" length)
get_filename_component(name ${SOURCE} NAME)
file(WRITE ${TARGET} "#include <string_view>\nnamespace palpate::material {\n"
     "extern const std::string_view chen2007_text;\n"
     "const std::string_view chen2007_text = R\"toml(${text})toml\";\n}\n")
