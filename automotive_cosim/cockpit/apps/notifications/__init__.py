"""The notifications: what requires attention now, and earlier notices."""
