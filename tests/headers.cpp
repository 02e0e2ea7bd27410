// Has nothing of its own: the target of the headers that every test reads precompiled.
