# Writes a .cpp that holds text files as strings of a room: NAME_text for NAME.toml.
# -DROOM=... "-DSOURCES=...;..." -DTARGET=...
set(strings "")
foreach(source IN LISTS SOURCES)
  file(READ ${source} text)
  get_filename_component(name ${source} NAME_WE)
  string(APPEND strings "extern const std::string_view ${name}_text;\n"
         "const std::string_view ${name}_text = R\"text(${text})text\";\n")
endforeach()
file(WRITE ${TARGET} "#include <string_view>\nnamespace palpate::${ROOM} {\n${strings}}\n")
