// Placeholder translation unit until the first source of this stage lands.
